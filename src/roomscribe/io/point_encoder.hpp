// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/geometry/point_cloud.hpp"
#include "roomscribe/io/atomic_file.hpp"
#include "roomscribe/io/point_fields.hpp"

namespace roomscribe {

/// One field of a file to be written, and where its values lie in memory, in native byte order:
/// those of the next point `stride` bytes further on.
struct FieldColumn {
    Field field;
    const std::byte* first = nullptr;
    std::size_t stride = 0;
};

/// A property of points whose values lie with somebody else, in native byte order.
struct ChannelView {
    std::string_view name;
    ScalarType type = ScalarType::float32;
    std::span<const std::byte> values;  ///< one per point
};

/// A run of points.
struct PointRange {
    std::size_t first = 0;
    std::size_t count = 0;
};

/// How a format calls and holds the properties of points.
enum class FieldStyle { pcd, ply, las };

/// Throws InvalidArgument if the cloud's arrays differ in length or a channel's name is not a word.
void check_cloud(const PointCloud& cloud);

/// A cloud as the fields of a file, in the order positions, normals, colours, intensity, channels.
/// It looks into the cloud, which must outlive it.
class PointColumns {
  public:
    /// Throws InvalidArgument as check_cloud does, or if PLY cannot hold a value (a 64-bit integer
    /// beyond 2^53).
    PointColumns(const PointCloud& cloud, FieldStyle style);

    /// The same of some of the points alone, so that what must be converted stays small, and with
    /// more properties. A property of the cloud that has the name of one of these is called
    /// "input_" and that.
    PointColumns(const PointCloud& cloud, FieldStyle style, PointRange range,
                 std::span<const ChannelView> more);

    std::span<const FieldColumn> columns() const { return columns_; }
    std::size_t num_points() const { return range_.count; }
    std::size_t record_bytes() const;

  private:
    void add(std::string name, ScalarType type, const void* first, std::size_t stride);
    void add_positions(const PointCloud& cloud);
    void add_colors(const PointCloud& cloud, FieldStyle style);
    void add_channel(const Channel& channel, std::string name, FieldStyle style);

    PointRange range_;
    std::vector<FieldColumn> columns_;
    std::list<std::vector<double>> doubles_;  ///< values that the cloud holds otherwise
    std::vector<std::uint32_t> packed_colors_;
};

/// Writes the points as records, one behind another.
void write_records(AtomicFile& file, const PointColumns& columns, std::endian order,
                   const Context& context);

/// Writes the points as lines of text.
void write_text(AtomicFile& file, const PointColumns& columns, const Context& context,
                char separator = ' ');

}  // namespace roomscribe
