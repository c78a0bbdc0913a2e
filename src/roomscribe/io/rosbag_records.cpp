// SPDX-License-Identifier: MIT
#include "roomscribe/io/rosbag_records.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include <bzlib.h>
#include <fmt/format.h>
#include <lz4frame.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/io/number_text.hpp"

namespace roomscribe {
namespace {

constexpr std::string_view magic = "#ROSBAG V2.0\n";
constexpr std::string_view cure = "the bag is damaged or cut off: rosbag reindex may mend it";
/// Beyond this ratio nothing that a scanner measured is packed: lz4 cannot do more, and bz2 only
/// does with zeros.
constexpr std::size_t max_ratio = 255;

enum class Op : std::uint8_t {
    message = 2,
    bag_header = 3,
    index = 4,
    chunk = 5,
    chunk_info = 6,
    connection = 7
};

/// Little-endian values, front to back, within bytes that may be a chunk's; throws IoError that
/// names the byte of the file at which those begin.
class Cursor {
  public:
    Cursor(std::span<const std::byte> bytes, const std::string& path, std::uint64_t place)
        : bytes_(bytes), path_(path), place_(place) {}

    bool at_end() const { return bytes_.empty(); }
    std::span<const std::byte> take(std::size_t size) {
        if (size > bytes_.size()) {
            fail(fmt::format("a record ends {} bytes too early", size - bytes_.size()));
        }
        const auto taken = bytes_.first(size);
        bytes_ = bytes_.subspan(size);
        return taken;
    }
    std::uint32_t read_size() {
        std::uint32_t size = 0;
        std::memcpy(&size, take(sizeof(size)).data(), sizeof(size));
        return std::endian::native == std::endian::little ? size : swap_bytes(size);
    }
    std::string_view take_text(std::size_t size) {
        const auto taken = take(size);
        return {reinterpret_cast<const char*>(taken.data()), taken.size()};
    }
    [[noreturn]] void fail(std::string_view reason) const {
        throw IoError(path_, rosbag_format, {.byte = place_, .line = {}}, reason, cure);
    }
    const std::string& path() const { return path_; }
    std::uint64_t place() const { return place_; }

  private:
    std::span<const std::byte> bytes_;
    const std::string& path_;
    std::uint64_t place_;
};

/// "name=value" fields.
class RecordHeader {
  public:
    explicit RecordHeader(Cursor fields) : cursor_(fields) {
        while (!fields.at_end()) {
            const std::string_view field = fields.take_text(fields.read_size());
            const std::size_t equals = field.find('=');
            if (equals == std::string_view::npos) fields.fail("a field of a record has no name");
            fields_.emplace(field.substr(0, equals), field.substr(equals + 1));
        }
    }
    std::string_view text(std::string_view name) const {
        const auto found = fields_.find(name);
        if (found == fields_.end()) {
            cursor_.fail(fmt::format("a record has no field '{}'", name));
        }
        return found->second;
    }
    std::uint32_t number(std::string_view name) const {
        const std::string_view value = text(name);
        Cursor bytes(std::as_bytes(std::span(value.data(), value.size())), cursor_.path(),
                     cursor_.place());
        return bytes.read_size();
    }
    Op op() const {
        const std::string_view value = text("op");
        if (value.size() != 1) cursor_.fail("a record has no operation");
        return static_cast<Op>(value.front());
    }

  private:
    Cursor cursor_;
    std::map<std::string_view, std::string_view> fields_;
};

std::vector<std::byte> unpack_bz2(std::span<const std::byte> packed, std::size_t size,
                                  const Cursor& cursor) {
    std::vector<std::byte> bytes(size);
    auto unpacked = static_cast<unsigned>(size);
    // bzlib's buffers are char* and not const, though it only reads the source.
    const int done =
        BZ2_bzBuffToBuffDecompress(reinterpret_cast<char*>(bytes.data()), &unpacked,
                                   const_cast<char*>(reinterpret_cast<const char*>(packed.data())),
                                   static_cast<unsigned>(packed.size()), 0, 0);
    if (done != BZ_OK || unpacked != size) cursor.fail("a bz2 chunk is damaged");
    return bytes;
}

std::vector<std::byte> unpack_lz4(std::span<const std::byte> packed, std::size_t size,
                                  const Cursor& cursor) {
    std::vector<std::byte> bytes(size);
    LZ4F_dctx* context = nullptr;
    if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION)) != 0) {
        throw std::bad_alloc();
    }
    std::size_t read = 0;
    std::size_t written = 0;
    std::size_t hint = 1;
    while (hint != 0 && LZ4F_isError(hint) == 0) {
        std::size_t in = packed.size() - read;
        std::size_t out = size - written;
        hint = LZ4F_decompress(context, bytes.data() + written, &out, packed.data() + read, &in,
                               nullptr);
        read += in;
        written += out;
        if (in == 0 && out == 0) break;
    }
    LZ4F_freeDecompressionContext(context);
    if (hint != 0 || written != size) cursor.fail("an lz4 chunk is damaged");
    return bytes;
}

class BagWalker {
  public:
    BagWalker(const MappedFile& file, const Context& context, const UseMessage& use)
        : file_(file), context_(context), use_(use) {}

    void walk_file() {
        const std::span<const std::byte> bytes = file_.bytes();
        if (!file_.text().starts_with(magic)) {
            throw IoError(file_.path(), rosbag_format, {.byte = 0, .line = {}},
                          "it does not begin like a ROS 1 bag of version 2.0",
                          "bags of ROS 2: convert them with rosbags-convert");
        }
        std::size_t place = magic.size();
        while (place < bytes.size()) {
            context_.throw_if_cancelled();
            Cursor cursor(bytes.subspan(place), file_.path(), place);
            const std::size_t size = walk_record(cursor, true);
            let_go(bytes.subspan(place, size));
            place += size;
        }
    }

  private:
    /// Returns the record's size.
    std::size_t walk_record(Cursor& cursor, bool may_be_chunk) {
        const std::uint32_t header_size = cursor.read_size();
        const RecordHeader header(Cursor(cursor.take(header_size), cursor.path(), cursor.place()));
        const std::uint32_t data_size = cursor.read_size();
        const std::span<const std::byte> data = cursor.take(data_size);
        switch (header.op()) {
            case Op::message:
                use_message(header, data, cursor);
                break;
            case Op::connection:
                add_connection(header, Cursor(data, cursor.path(), cursor.place()));
                break;
            case Op::chunk:
                if (!may_be_chunk) cursor.fail("a chunk within a chunk");
                walk_chunk(header, data, cursor);
                break;
            default:  // indexes
                break;
        }
        return std::size_t{8} + header_size + data_size;
    }

    void walk_chunk(const RecordHeader& header, std::span<const std::byte> data,
                    const Cursor& cursor) {
        const std::string_view compression = header.text("compression");
        const std::size_t size = header.number("size");
        std::vector<std::byte> unpacked;
        if (compression != "none") {
            if (size > max_ratio * data.size()) {
                cursor.fail(fmt::format("{} packed bytes cannot hold the {} that they claim",
                                        data.size(), size));
            }
            if (compression == "bz2") {
                unpacked = unpack_bz2(data, size, cursor);
            } else if (compression == "lz4") {
                unpacked = unpack_lz4(data, size, cursor);
            } else {
                cursor.fail(fmt::format("the compression {} is unknown", quote_text(compression)));
            }
            data = unpacked;
        }
        Cursor inner(data, cursor.path(), cursor.place());
        while (!inner.at_end())
            walk_record(inner, false);
    }

    void add_connection(const RecordHeader& header, Cursor data) {
        const RecordHeader described(data);
        BagConnection connection{std::string(header.text("topic")),
                                 std::string(described.text("type")),
                                 std::string(described.text("message_definition"))};
        connections_.insert_or_assign(header.number("conn"), std::move(connection));
    }

    void use_message(const RecordHeader& header, std::span<const std::byte> data,
                     const Cursor& cursor) {
        const auto connection = connections_.find(header.number("conn"));
        if (connection == connections_.end()) cursor.fail("a message of no connection");
        use_(connection->second, data);
    }

    const MappedFile& file_;
    const Context& context_;
    const UseMessage& use_;
    std::map<std::uint32_t, BagConnection> connections_;
};

}  // namespace

void for_each_bag_message(const MappedFile& file, const Context& context, const UseMessage& use) {
    BagWalker(file, context, use).walk_file();
}

}  // namespace roomscribe
