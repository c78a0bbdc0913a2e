// SPDX-License-Identifier: MIT
#include "roomscribe/registration/features/narf_patch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "roomscribe/registration/range_image/symmetric_matrix.hpp"

namespace roomscribe {
namespace {

constexpr std::size_t coarse_side = narf_patch_side / 2;
using CoarsePatch = std::array<float, coarse_side * coarse_side>;
constexpr float unseen = std::numeric_limits<float>::infinity();

/// Calls visit(x, y) for the square rings of pixels around one, from `first_radius` on, until no
/// pixel of a ring beyond `last_certain` was of use.
template <typename Visit>
void visit_rings(const RangeImage& image, int x, int y, int first_radius, int last_certain,
                 Visit&& visit) {
    bool is_of_use = true;
    for (int radius = first_radius; is_of_use; ++radius) {
        is_of_use = radius <= last_certain;
        for (int y2 = std::max(y - radius, 0); y2 <= std::min(y + radius, image.height - 1); ++y2) {
            const bool is_whole_row = y2 == y - radius || y2 == y + radius;
            const int step = is_whole_row ? 1 : 2 * radius;
            for (int x2 = x - radius; x2 <= x + radius; x2 += step) {
                if (image.has_range(x2, y2) && visit(x2, y2)) is_of_use = true;
            }
        }
    }
}

/// A plane through weighted points, relative to a center that keeps the numbers small.
class PlaneFit {
  public:
    void add(const Eigen::Vector3f& offset, float weight) {
        squares_.add_square(offset, weight);
        sum_ += weight * offset;
        weight_ += weight;
        ++count_;
    }
    int count() const { return count_; }
    Eigen::Vector3f mean() const { return sum_ / weight_; }
    Eigen::Vector3f normal() const {
        SymmetricMatrix covariance = squares_;
        covariance.add_square(mean(), -weight_);
        return covariance.eigenvector(covariance.smallest_eigenvalue());
    }

  private:
    SymmetricMatrix squares_;
    Eigen::Vector3f sum_ = Eigen::Vector3f::Zero();
    float weight_ = 0.0F;
    int count_ = 0;
};

/// The points within a radius. Those far from the center weigh more: they say more about the tilt.
PlaneFit fit_around(const RangeImage& image, std::size_t pixel, float radius) {
    const Eigen::Vector3f& center = image.points[pixel];
    PlaneFit fit;
    visit_rings(image, image.column(pixel), image.row(pixel), 1, 0, [&](int x, int y) {
        const Eigen::Vector3f offset = image.points[image.index(x, y)] - center;
        const float squared_distance = offset.squaredNorm();
        if (squared_distance > radius * radius) return false;
        if (squared_distance > 0.0F) fit.add(offset, std::sqrt(squared_distance) / radius);
        return true;
    });
    return fit;
}

/// Of the 5 x 5 pixels those within twice the distance of the 15th nearest.
PlaneFit fit_nearest(const RangeImage& image, std::size_t pixel) {
    constexpr int radius = 2;
    constexpr std::size_t num_nearest = 15;
    const int x = image.column(pixel);
    const int y = image.row(pixel);
    std::vector<Eigen::Vector3f> offsets;
    for (int y2 = y - radius; y2 <= y + radius; ++y2) {
        for (int x2 = x - radius; x2 <= x + radius; ++x2) {
            if (!image.has_range(x2, y2)) continue;
            offsets.emplace_back(image.points[image.index(x2, y2)] - image.points[pixel]);
        }
    }
    const auto nth =
        offsets.begin() + static_cast<std::ptrdiff_t>(std::min(offsets.size(), num_nearest)) - 1;
    std::nth_element(offsets.begin(), nth, offsets.end(), [](const auto& a, const auto& b) {
        return a.squaredNorm() < b.squaredNorm();
    });
    const float squared_reach = 4.0F * nth->squaredNorm();
    PlaneFit fit;
    for (const Eigen::Vector3f& offset : offsets) {
        if (offset.squaredNorm() <= squared_reach) fit.add(offset, 1.0F);
    }
    return fit;
}

/// A triangle of neighbouring points in cells (x, y) and metres (z).
struct Triangle {
    Eigen::Vector3f a, b, c;

    /// Lowers the cells whose middle it covers to its depth there.
    void draw(CoarsePatch& patch) const {
        const auto [left, right] = cell_span(a.x(), b.x(), c.x());
        const auto [top, bottom] = cell_span(a.y(), b.y(), c.y());
        const Eigen::Vector2f side_b = (b - a).head<2>();
        const Eigen::Vector2f side_c = (c - a).head<2>();
        const float inverse = 1.0F / (side_b.x() * side_c.y() - side_b.y() * side_c.x());
        // Cells on an edge may not be lost to rounding.
        constexpr float margin = 0.01F;
        for (int y = top; y <= bottom; ++y) {
            for (int x = left; x <= right; ++x) {
                const Eigen::Vector2f offset(static_cast<float>(x) - a.x(),
                                             static_cast<float>(y) - a.y());
                const float share_b = (offset.x() * side_c.y() - offset.y() * side_c.x()) * inverse;
                const float share_c = (side_b.x() * offset.y() - side_b.y() * offset.x()) * inverse;
                if (!(share_b >= -margin && share_c >= -margin &&
                      share_b + share_c <= 1.0F + margin)) {
                    continue;
                }
                float& depth =
                    patch[static_cast<std::size_t>(y) * coarse_side + static_cast<std::size_t>(x)];
                depth =
                    std::min(depth, a.z() + share_b * (b.z() - a.z()) + share_c * (c.z() - a.z()));
            }
        }
    }

  private:
    static std::array<int, 2> cell_span(float a, float b, float c) {
        constexpr auto last = static_cast<float>(coarse_side - 1);
        return {static_cast<int>(std::ceil(std::max(std::min({a, b, c}), 0.0F))),
                static_cast<int>(std::floor(std::min(std::max({a, b, c}), last)))};
    }
};

/// True if all three lie on one side of [low, high].
bool is_beside(float a, float b, float c, float low, float high) {
    return (a < low && b < low && c < low) || (a > high && b > high && c > high);
}

CoarsePatch draw_surface(const RangeImage& image, std::size_t pixel, const Eigen::Isometry3f& frame,
                         float support_size) {
    const float half_size = 0.5F * support_size;
    const float cells_per_metre = static_cast<float>(coarse_side) / support_size;
    const float middle = 0.5F * static_cast<float>(coarse_side) - 0.5F;
    const float low = -half_size * cells_per_metre + middle;
    const float high = half_size * cells_per_metre + middle;
    CoarsePatch patch;
    patch.fill(unseen);
    const auto cell_of = [&](int x, int y, Eigen::Vector3f& cell) {
        if (!image.has_range(x, y)) return false;
        cell = frame * image.points[image.index(x, y)];
        if (std::abs(cell.z()) > half_size) return false;
        cell.x() = cells_per_metre * cell.x() + middle;
        cell.y() = cells_per_metre * cell.y() + middle;
        return true;
    };
    visit_rings(image, image.column(pixel), image.row(pixel), 0, 1, [&](int x, int y) {
        Triangle triangle;
        if (!cell_of(x, y, triangle.a) || !cell_of(x + 1, y + 1, triangle.b)) return false;
        bool is_of_use = false;
        for (const auto& [x3, y3] : {std::array<int, 2>{x, y + 1}, std::array<int, 2>{x + 1, y}}) {
            if (!cell_of(x3, y3, triangle.c)) continue;
            const auto& [a, b, c] = triangle;
            if (is_beside(a.x(), b.x(), c.x(), low, high) ||
                is_beside(a.y(), b.y(), c.y(), low, high)) {
                continue;
            }
            is_of_use = true;
            triangle.draw(patch);
        }
        return is_of_use;
    });
    return patch;
}

}  // namespace

std::optional<Eigen::Isometry3f> narf_frame(const RangeImage& image, std::size_t pixel,
                                            float support_size) {
    if (!image.has_range(pixel)) return std::nullopt;
    constexpr int few = 10;
    PlaneFit fit = fit_around(image, pixel, 0.5F * support_size);
    if (fit.count() <= few) fit = fit_nearest(image, pixel);
    if (fit.count() < 3) return std::nullopt;
    const Eigen::Vector3f& center = image.points[pixel];
    Eigen::Vector3f normal = fit.normal();
    if (normal.dot(center + fit.mean() - image.sensor_position) < 0.0F) normal = -normal;
    Eigen::Vector3f right = normal.cross(image.up);
    const float tilt = right.norm();
    // On a level surface no direction is up; then one as good as any other.
    right = tilt > 1e-6F ? Eigen::Vector3f(right / tilt) : normal.unitOrthogonal();
    Eigen::Isometry3f frame = Eigen::Isometry3f::Identity();
    frame.linear().row(0) = right;
    frame.linear().row(1) = normal.cross(right);
    frame.linear().row(2) = normal;
    const Eigen::Vector3f origin = center + normal.dot(fit.mean()) * normal;
    frame.translation() = -(frame.linear() * origin);
    return frame;
}

NarfPatch narf_patch(const RangeImage& image, std::size_t pixel, const Eigen::Isometry3f& frame,
                     float support_size) {
    const CoarsePatch coarse = draw_surface(image, pixel, frame, support_size);
    const auto depth_at = [&](std::size_t x, std::size_t y) {
        const float depth = coarse[y / 2 * coarse_side + x / 2];
        return depth == unseen ? 0.5F * support_size : depth;
    };
    NarfPatch patch;
    constexpr std::size_t last = narf_patch_side - 1;
    for (std::size_t y = 0; y <= last; ++y) {
        for (std::size_t x = 0; x <= last; ++x) {
            float sum = 0.0F;
            float count = 0.0F;
            for (std::size_t y2 = std::max<std::size_t>(y, 1) - 1; y2 <= std::min(y + 1, last);
                 ++y2) {
                for (std::size_t x2 = std::max<std::size_t>(x, 1) - 1; x2 <= std::min(x + 1, last);
                     ++x2) {
                    sum += depth_at(x2, y2);
                    count += 1.0F;
                }
            }
            patch[y * narf_patch_side + x] = sum / count;
        }
    }
    return patch;
}

}  // namespace roomscribe
