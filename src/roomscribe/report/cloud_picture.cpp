// SPDX-License-Identifier: MIT
#include "roomscribe/report/cloud_picture.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "roomscribe/core/error.hpp"
#include "roomscribe/core/parallel.hpp"
#include "roomscribe/core/quantile.hpp"

namespace roomscribe {
namespace {

constexpr std::size_t points_per_chunk = 1U << 16U;
constexpr std::size_t rows_per_chunk = 32;
constexpr double max_pixels = 1e8;

/// A grid of values with the picture's size; what lies outside is a default value.
template <typename Value>
struct Raster {
    std::ptrdiff_t width = 0;
    std::ptrdiff_t height = 0;
    std::vector<Value> values;

    Raster(std::size_t raster_width, std::size_t raster_height)
        : width(static_cast<std::ptrdiff_t>(raster_width)),
          height(static_cast<std::ptrdiff_t>(raster_height)),
          values(raster_width * raster_height) {}

    Value& at(std::ptrdiff_t row, std::ptrdiff_t column) {
        return values[static_cast<std::size_t>(row * width + column)];
    }
    Value get(std::ptrdiff_t row, std::ptrdiff_t column) const {
        const bool inside = row >= 0 && row < height && column >= 0 && column < width;
        return inside ? values[static_cast<std::size_t>(row * width + column)] : Value{};
    }
};

/// Calls body(row, column) for every pixel; a body may write to its own pixel only.
template <typename Value, typename Body>
void for_each_pixel(const Context& context, const Raster<Value>& raster, const Body& body) {
    parallel_for(context, static_cast<std::size_t>(raster.height), rows_per_chunk,
                 [&](std::size_t begin, std::size_t end) {
                     for (auto row = static_cast<std::ptrdiff_t>(begin);
                          row < static_cast<std::ptrdiff_t>(end); ++row) {
                         for (std::ptrdiff_t column = 0; column < raster.width; ++column) {
                             body(row, column);
                         }
                     }
                 });
}

/// Calls body(index, row, column, depth in [0, 1]) for the points that the view shows.
template <typename Body>
void for_each_visible(std::span<const Eigen::Vector3f> points, const CloudView& view,
                      const Context& context, const Body& body) {
    const Eigen::Vector3d extent = view.high - view.low;
    const double scale = 1.0 / view.pixel_size();
    const Eigen::Vector3d scales(scale, scale, 1.0 / extent.z());
    const Eigen::Matrix3f linear =
        (scales.asDiagonal() * view.view_from_cloud.linear()).cast<float>();
    const Eigen::Vector3f offset =
        (scales.asDiagonal() * (view.view_from_cloud.translation() - view.low)).cast<float>();
    const auto width = static_cast<float>(view.width);
    const auto height = static_cast<float>(extent.y() * scale);
    const auto last_row = static_cast<std::ptrdiff_t>(view.height()) - 1;
    parallel_for(context, points.size(), points_per_chunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Eigen::Vector3f p = linear * points[i] + offset;
            // Written so that NaN fails, too.
            const bool inside = p.x() >= 0.0F && p.x() < width && p.y() >= 0.0F && p.y() < height &&
                                p.z() >= 0.0F && p.z() <= 1.0F;
            if (!inside) continue;
            body(i, last_row - static_cast<std::ptrdiff_t>(p.y()),
                 static_cast<std::ptrdiff_t>(p.x()), p.z());
        }
    });
}

/// Depth above, point number below, so that the greatest key is the nearest point, and the first of
/// equally near ones. 0 is a pixel without a point.
std::uint64_t key_of(float depth, std::size_t index) {
    const auto steps = static_cast<std::uint64_t>(1.0 + static_cast<double>(depth) * 4294967294.0);
    return (steps << 32U) | (0xFFFFFFFFU - static_cast<std::uint32_t>(index));
}
std::size_t index_of(std::uint64_t key) {
    return 0xFFFFFFFFU - static_cast<std::uint32_t>(key);
}
float depth_of(std::uint64_t key) {
    return static_cast<float>(static_cast<double>(key >> 32U) / 4294967295.0);
}

void raise_to(std::uint64_t& value, std::uint64_t key) {
    const std::atomic_ref<std::uint64_t> shared(value);
    std::uint64_t present = shared.load(std::memory_order_relaxed);
    while (present < key &&
           !shared.compare_exchange_weak(present, key, std::memory_order_relaxed)) {
    }
}

template <typename Value>
Value greatest_around(const Raster<Value>& raster, std::ptrdiff_t row, std::ptrdiff_t column,
                      std::ptrdiff_t radius) {
    Value greatest{};
    for (std::ptrdiff_t dy = -radius; dy <= radius; ++dy) {
        for (std::ptrdiff_t dx = -radius; dx <= radius; ++dx) {
            if (dx * dx + dy * dy > radius * radius + 1) continue;
            greatest = std::max(greatest, raster.get(row + dy, column + dx));
        }
    }
    return greatest;
}

/// Pixels from one point to the next on the surfaces seen: blocks of pixels that hold any point,
/// against pixels that hold one.
template <typename Value, typename IsFilled>
double mean_spacing(const Raster<Value>& raster, const IsFilled& is_filled) {
    constexpr std::ptrdiff_t block = 16;
    Raster<std::uint8_t> blocks(static_cast<std::size_t>(raster.width / block + 1),
                                static_cast<std::size_t>(raster.height / block + 1));
    double num_filled = 0.0;
    for (std::ptrdiff_t row = 0; row < raster.height; ++row) {
        for (std::ptrdiff_t column = 0; column < raster.width; ++column) {
            if (!is_filled(raster.get(row, column))) continue;
            num_filled += 1.0;
            blocks.at(row / block, column / block) = 1;
        }
    }
    if (num_filled == 0.0) return 1.0;
    const auto num_blocks =
        static_cast<double>(std::count(blocks.values.begin(), blocks.values.end(), 1));
    return std::sqrt(num_blocks * block * block / num_filled);
}

/// The greatest (or least) of each pixel and its neighbours: the four at its sides, or all eight.
template <bool greatest>
void spread(Raster<std::uint64_t>& keys, bool with_corners, const Context& context) {
    const Raster<std::uint64_t> before = keys;
    for_each_pixel(context, keys, [&](std::ptrdiff_t row, std::ptrdiff_t column) {
        std::uint64_t extreme = before.get(row, column);
        for (std::ptrdiff_t dy = -1; dy <= 1; ++dy) {
            for (std::ptrdiff_t dx = -1; dx <= 1; ++dx) {
                if (!with_corners && dx != 0 && dy != 0) continue;
                const std::uint64_t key = before.get(row + dy, column + dx);
                extreme = greatest ? std::max(extreme, key) : std::min(extreme, key);
            }
        }
        keys.at(row, column) = extreme;
    });
}

/// Morphological closing by an octagon: a gap, or a pit of points that shine through from behind,
/// takes the depth of the surface around it if the octagon does not fit in. Outlines stay.
void close_gaps(Raster<std::uint64_t>& keys, std::ptrdiff_t radius, const Context& context) {
    const Raster<std::uint64_t> before = keys;
    for (std::ptrdiff_t k = 0; k < radius; ++k)
        spread<true>(keys, k % 2 == 0, context);
    for (std::ptrdiff_t k = 0; k < radius; ++k)
        spread<false>(keys, k % 2 == 0, context);
    // Beyond the picture's edge there is nothing to hold the surface up against the last step.
    std::transform(keys.values.begin(), keys.values.end(), before.values.begin(),
                   keys.values.begin(),
                   [](std::uint64_t a, std::uint64_t b) { return std::max(a, b); });
}

std::uint8_t byte_of(float value) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0F, 255.0F)));
}

/// Few levels instead of all: the file becomes a fraction of the size and looks the same.
float in_levels(float value, float levels) {
    return std::round(value * levels) / levels;
}

/// Mean of the filled pixels' depths in a square around each pixel.
Raster<float> blurred_depth(const Raster<std::uint64_t>& keys, std::ptrdiff_t radius,
                            const Context& context) {
    struct Sum {
        float depth = 0.0F;
        float count = 0.0F;
    };
    const auto width = static_cast<std::size_t>(keys.width);
    const auto height = static_cast<std::size_t>(keys.height);
    Raster<Sum> along_rows(width, height);
    for_each_pixel(context, keys, [&](std::ptrdiff_t row, std::ptrdiff_t column) {
        Sum& sum = along_rows.at(row, column);
        for (std::ptrdiff_t dx = -radius; dx <= radius; ++dx) {
            const std::uint64_t key = keys.get(row, column + dx);
            if (key == 0) continue;
            sum.depth += depth_of(key);
            sum.count += 1.0F;
        }
    });
    Raster<float> blurred(width, height);
    for_each_pixel(context, keys, [&](std::ptrdiff_t row, std::ptrdiff_t column) {
        Sum total;
        for (std::ptrdiff_t dy = -radius; dy <= radius; ++dy) {
            const Sum sum = along_rows.get(row + dy, column);
            total.depth += sum.depth;
            total.count += sum.count;
        }
        blurred.at(row, column) = total.count > 0.0F ? total.depth / total.count : 0.0F;
    });
    return blurred;
}

/// Pixels that a length in metres takes, within limits.
std::ptrdiff_t in_pixels(double length, const CloudView& view, double low, double high) {
    return static_cast<std::ptrdiff_t>(std::clamp(length / view.pixel_size(), low, high));
}

Image draw_surface(std::span<const Eigen::Vector3f> points, const PointColor& color,
                   const CloudView& view, const Context& context) {
    Raster<std::uint64_t> hits(view.width, view.height());
    for_each_visible(
        points, view, context,
        [&](std::size_t index, std::ptrdiff_t row, std::ptrdiff_t column, float depth) {
            if (color(index)[3] == 0) return;
            raise_to(hits.at(row, column), key_of(depth, index));
        });

    const double spacing = mean_spacing(hits, [](std::uint64_t key) { return key != 0; });
    const auto radius =
        static_cast<std::ptrdiff_t>(std::clamp(std::floor(spacing / 2.0), 0.0, 4.0));
    Raster<std::uint64_t> keys = hits;
    for_each_pixel(context, keys, [&](std::ptrdiff_t row, std::ptrdiff_t column) {
        keys.at(row, column) = greatest_around(hits, row, column, radius);
    });
    constexpr double half_gap = 0.045;  // m
    close_gaps(keys, in_pixels(half_gap, view, static_cast<double>(radius + 1), 10.0), context);

    // What lies lower than its surroundings gets darker (unsharp masking the depth buffer, Luft et
    // al. 2006): steps show as soft shadows, the scanner's noise hardly.
    constexpr double shadow_reach = 0.06;  // m
    constexpr float full_step = 0.35F;     // m
    constexpr float darkest = 0.5F;
    const Raster<float> surroundings =
        blurred_depth(keys, in_pixels(shadow_reach, view, 3.0, 24.0), context);
    const auto metres = static_cast<float>(view.high.z() - view.low.z());
    Image image(view.width, view.height());
    for_each_pixel(context, keys, [&](std::ptrdiff_t row, std::ptrdiff_t column) {
        const std::uint64_t key = keys.get(row, column);
        if (key == 0) return;
        const Pixel base = color(index_of(key));
        const float depth = depth_of(key);
        const float sunken = (surroundings.get(row, column) - depth) * metres / full_step;
        const float shade = in_levels(1.0F - darkest * std::clamp(sunken, 0.0F, 1.0F), 16.0F);
        const float opacity = in_levels(0.42F + 0.58F * std::sqrt(depth), 12.0F);
        Pixel& pixel = image.at(static_cast<std::size_t>(row), static_cast<std::size_t>(column));
        for (std::size_t c = 0; c < 3; ++c)
            pixel[c] = byte_of(static_cast<float>(base[c]) * shade);
        // A shaded pixel is opaque, so that edges stay dark on a light page.
        const float covered = 1.0F - shade * (1.0F - opacity);
        pixel[3] = byte_of(static_cast<float>(base[3]) * covered);
    });
    return image;
}

/// What lies behind a pixel of an X-ray: sums of the colours, and how many.
struct Pile {
    std::array<std::uint32_t, 3> color{};
    std::uint32_t count = 0;
};

void add_to(std::uint32_t& sum, std::uint32_t value) {
    std::atomic_ref<std::uint32_t>(sum).fetch_add(value, std::memory_order_relaxed);
}

/// Count that only one filled pixel in fifty exceeds.
float high_count(const Raster<Pile>& piles) {
    std::vector<std::uint32_t> counts;
    for (const Pile& pile : piles.values) {
        if (pile.count > 0) counts.push_back(pile.count);
    }
    if (counts.empty()) return 1.0F;
    return static_cast<float>(quantile(counts, 0.98));
}

Image draw_density(std::span<const Eigen::Vector3f> points, const PointColor& color,
                   const CloudView& view, const Context& context) {
    Raster<Pile> piles(view.width, view.height());
    for_each_visible(points, view, context,
                     [&](std::size_t index, std::ptrdiff_t row, std::ptrdiff_t column, float) {
                         const Pixel pixel = color(index);
                         if (pixel[3] == 0) return;
                         Pile& pile = piles.at(row, column);
                         for (std::size_t c = 0; c < 3; ++c)
                             add_to(pile.color[c], pixel[c]);
                         add_to(pile.count, 1);
                     });

    const double spacing = mean_spacing(piles, [](const Pile& pile) { return pile.count > 0; });
    const auto radius =
        static_cast<std::ptrdiff_t>(std::clamp(std::round(spacing / 4.0), 0.0, 2.0));
    const float full = std::log1p(high_count(piles) * static_cast<float>(2 * radius + 1));
    Image image(view.width, view.height());
    for_each_pixel(context, piles, [&](std::ptrdiff_t row, std::ptrdiff_t column) {
        std::array<std::uint64_t, 3> color_sum{};
        std::uint64_t count = 0;
        for (std::ptrdiff_t dy = -radius; dy <= radius; ++dy) {
            for (std::ptrdiff_t dx = -radius; dx <= radius; ++dx) {
                const Pile pile = piles.get(row + dy, column + dx);
                for (std::size_t c = 0; c < 3; ++c)
                    color_sum[c] += pile.color[c];
                count += pile.count;
            }
        }
        if (count == 0) return;
        Pixel& pixel = image.at(static_cast<std::size_t>(row), static_cast<std::size_t>(column));
        for (std::size_t c = 0; c < 3; ++c) {
            const float mean = static_cast<float>(color_sum[c]) / static_cast<float>(count);
            pixel[c] = byte_of(in_levels(mean / 255.0F, 8.0F) * 255.0F);
        }
        const float opacity =
            0.2F + 0.8F * std::min(1.0F, std::log1p(static_cast<float>(count)) / full);
        pixel[3] = byte_of(255.0F * in_levels(opacity, 8.0F));
    });
    return image;
}

}  // namespace

std::size_t CloudView::height() const {
    const double rows = std::ceil((high.y() - low.y()) / pixel_size() - 1e-6);
    return static_cast<std::size_t>(std::max(rows, 1.0));
}

Image draw_cloud(std::span<const Eigen::Vector3f> points, const PointColor& color,
                 const CloudView& view, PictureStyle style, const Context& context) {
    const Eigen::Vector3d extent = view.high - view.low;
    const double rows = extent.y() / extent.x() * static_cast<double>(view.width);
    const bool has_extent = extent.allFinite() && (extent.array() > 0.0).all() && view.width > 0;
    if (!has_extent || rows * static_cast<double>(view.width) > max_pixels) {
        throw InvalidArgument("view",
                              fmt::format("{} x {} x {} m on {} pixels", extent.x(), extent.y(),
                                          extent.z(), view.width),
                              "a box with an extent and at most 100 million pixels");
    }
    return style == PictureStyle::surface ? draw_surface(points, color, view, context)
                                          : draw_density(points, color, view, context);
}

}  // namespace roomscribe
