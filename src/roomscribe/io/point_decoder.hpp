// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "roomscribe/core/context.hpp"
#include "roomscribe/geometry/point_cloud.hpp"
#include "roomscribe/io/file_contents.hpp"
#include "roomscribe/io/point_fields.hpp"

namespace roomscribe {

/// Where the values of one field lie in memory: those of the next point `stride` bytes further on.
struct FieldSource {
    const std::byte* first = nullptr;
    std::size_t stride = 0;
};

struct SourceRun;

/// Bytes of one record that holds the fields one behind another.
std::size_t record_bytes(std::span<const Field> fields);

/// The sources of fields that lie one behind another in records that begin at `records`.
std::vector<FieldSource> record_sources(std::span<const Field> fields, const std::byte* records);

/// One value of a type, its bytes turned round if `swap`, as double.
double load_as_double(const std::byte* bytes, ScalarType type, bool swap);

/// Turns the fields of a file into a cloud, by the rules of names in point_cloud_io.hpp, or into
/// the summary of one, of which it then keeps no points.
class PointDecoder {
  public:
    /// Makes room for the points of a cloud. Precondition: has_positions(fields).
    PointDecoder(std::span<const Field> fields, std::size_t num_points, PointsAs as);

    /// Positions in the file are steps: value * scale + offset, in double. Call it before decode.
    void quantize_positions(const Eigen::Vector3d& scale, const Eigen::Vector3d& offset);

    static bool has_positions(std::span<const Field> fields);

    /// Sets the points [first, first + count) from sources, one per field, in the given byte order.
    /// Call it from the first point to the last: the first finite one decides the global shift.
    void decode(std::span<const FieldSource> sources, std::size_t first, std::size_t count,
                std::endian order, const Context& context);

    /// Puts the cloud or the summary where it belongs. A sensor pose in the file's coordinates is
    /// moved by the global shift.
    void finish(FileContents& contents, const std::optional<Transform>& file_sensor_pose,
                const std::optional<ScanGrid>& grid);

    /// The same for all points, whose records lie in a MappedFile one behind another: the memory of
    /// each run of them is given back once it is decoded.
    void decode_mapped(std::span<const std::byte> records, std::endian order,
                       const Context& context);

  private:
    struct Triple {
        std::array<std::size_t, 3> fields;
    };

    void make_room();
    void choose_global_shift(const SourceRun& run);
    void decode_positions(Eigen::Vector3f* target, const SourceRun& run) const;
    void decode_run(const SourceRun& run);
    PointSummary summarize_run(const SourceRun& run) const;

    std::vector<Field> fields_;
    std::size_t num_points_;
    PointsAs as_;
    Triple position_;
    std::optional<Triple> normal_;
    std::optional<Triple> color_;
    std::optional<std::size_t> packed_color_;
    std::optional<std::size_t> intensity_;
    std::vector<std::size_t> channel_fields_;  ///< the field of each channel
    Eigen::Vector3d scale_ = Eigen::Vector3d::Ones();
    Eigen::Vector3d offset_ = Eigen::Vector3d::Zero();
    bool shift_known_ = false;
    PointCloud cloud_;
    PointSummary summary_;
};

}  // namespace roomscribe
