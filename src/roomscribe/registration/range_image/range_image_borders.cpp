// SPDX-License-Identifier: MIT
#include "roomscribe/registration/range_image/range_image_borders.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "roomscribe/core/parallel.hpp"
#include "roomscribe/registration/range_image/range_image_surface.hpp"

namespace roomscribe {
namespace {

constexpr int plane_radius = 2;      // pixels, of the border directions that are averaged
constexpr int curvature_radius = 2;  // pixels, of the normals whose spread is taken
constexpr float min_score = 0.1F;

/// Left, right, up, down; the opposite of direction d is d ^ 1.
constexpr std::array<std::array<int, 2>, 4> steps{{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};

/// A border that has its shadow, `shadow_distance` pixels on in its direction.
struct BorderCandidate {
    int x = 0;
    int y = 0;
    int direction = 0;
    int shadow_distance = 0;
};

class BorderFinder {
  public:
    BorderFinder(const RangeImage& image, const RangeImageBorderSettings& settings,
                 const Context& context)
        : image_(image),
          radius_(settings.border_radius),
          min_border_score_(static_cast<float>(settings.min_border_score)),
          context_(context),
          surface_(find_surface(image, settings.border_radius, context)) {
        borders_.traits.assign(image.size(), 0);
        borders_.surface_change_scores.assign(image.size(), 0.0F);
        borders_.surface_change_directions.assign(image.size(), Eigen::Vector3f::Zero());
    }

    RangeImageBorders find() {
        for_rows([&](int y) { score_row(y); });
        for_rows([&](int y) { strengthen_row(y); });
        for (const BorderCandidate& candidate : find_candidates()) {
            if (is_maximum(candidate)) mark(candidate);
        }
        find_border_directions();
        for_rows([&](int y) { find_curvature_in_row(y); });
        return std::move(borders_);
    }

  private:
    using Scores = std::array<std::vector<float>, 4>;

    template <typename Body>
    void for_rows(Body&& body) const {
        parallel_for(context_, static_cast<std::size_t>(image_.height), 8,
                     [&](std::size_t begin, std::size_t end) {
                         for (std::size_t y = begin; y < end; ++y)
                             body(static_cast<int>(y));
                     });
    }

    /// How far the surface jumps towards the mean of the next pixels on one side, compared to its
    /// spacing: towards 1 if away from the scanner, towards -1 if nearer to it.
    float jump_score(std::size_t pixel, std::size_t padded, std::ptrdiff_t stride,
                     int num_pixels) const {
        const PaddedPoints& points = surface_.points;
        const std::size_t first = padded + static_cast<std::size_t>(stride);
        if (points.range[first] == RangeImage::far) return 1.0F;
        float x = 0.0F;
        float y = 0.0F;
        float z = 0.0F;
        float range = 0.0F;
        float count = 0.0F;
        std::size_t other = first;
        for (int i = 0; i < num_pixels; ++i, other += static_cast<std::size_t>(stride)) {
            if (!std::isfinite(points.range[other])) continue;
            x += points.x[other];
            y += points.y[other];
            z += points.z[other];
            range += points.range[other];
            count += 1.0F;
        }
        if (count == 0.0F) return 0.0F;
        const float scale = 1.0F / count;
        const float dx = scale * x - points.x[padded];
        const float dy = scale * y - points.y[padded];
        const float dz = scale * z - points.z[padded];
        const float squared_distance = dx * dx + dy * dy + dz * dz;
        const float reach = surface_.squared_reach[pixel];
        if (squared_distance <= reach) return 0.0F;
        const float score = 1.0F - std::sqrt(reach / squared_distance);
        return scale * range < points.range[padded] ? -score : score;
    }

    void score_row(int y) {
        const auto down = static_cast<std::ptrdiff_t>(surface_.points.stride);
        const std::array<std::ptrdiff_t, 4> strides{-1, 1, -down, down};
        for (int x = 0; x < image_.width; ++x) {
            const std::size_t i = image_.index(x, y);
            if (!surface_.is_known(i)) continue;
            const std::size_t padded = surface_.points.index(x, y);
            for (std::size_t d = 0; d < 4; ++d)
                raw_scores_[d][i] = jump_score(i, padded, strides[d], radius_);
        }
    }

    /// A border goes on in its neighbours, noise does not.
    void strengthen_row(int y) {
        constexpr float max_bonus = 0.5F;
        for (std::size_t d = 0; d < 4; ++d) {
            for (int x = 0; x < image_.width; ++x) {
                const std::size_t i = image_.index(x, y);
                const float score = raw_scores_[d][i];
                scores_[d][i] = score;
                if (score + max_bonus * (1.0F - score) < min_border_score_) continue;
                float sum = 0.0F;
                float count = 0.0F;
                for (int y2 = std::max(y - 1, 0); y2 <= std::min(y + 1, image_.height - 1); ++y2) {
                    for (int x2 = std::max(x - 1, 0); x2 <= std::min(x + 1, image_.width - 1);
                         ++x2) {
                        if (x2 == x && y2 == y) continue;
                        sum += raw_scores_[d][image_.index(x2, y2)];
                        count += 1.0F;
                    }
                }
                if (count == 0.0F || sum * score < 0.0F) continue;
                scores_[d][i] = score + max_bonus * sum / count * (1.0F - std::abs(score));
            }
        }
    }

    /// Where the surface behind jumps towards the obstacle most; 0 if nowhere.
    int find_shadow(int x, int y, std::size_t d, float& shadow_score) const {
        const auto [dx, dy] = steps[d];
        if (scores_[d][image_.index(x, y)] == 1.0F && image_.contains(x + dx, y + dy) &&
            image_.ranges[image_.index(x + dx, y + dy)] == RangeImage::far) {
            shadow_score = -1.0F;
            return 1;
        }
        int best = 0;
        shadow_score = 0.0F;
        for (int distance = 1; distance <= radius_; ++distance) {
            const int x2 = x + distance * dx;
            const int y2 = y + distance * dy;
            if (!image_.contains(x2, y2)) break;
            const float score = scores_[d ^ 1U][image_.index(x2, y2)];
            if (score < shadow_score) {
                shadow_score = score;
                best = distance;
            }
        }
        return best;
    }

    /// Borders without a shadow lose their score. Only scores above zero change and only scores
    /// below zero are looked for, so the order is of no matter.
    std::vector<BorderCandidate> find_candidates() {
        std::vector<BorderCandidate> candidates;
        for (std::size_t i = 0; i < image_.size(); ++i) {
            for (std::size_t d = 0; d < 4; ++d) {
                float& score = scores_[d][i];
                if (score < min_border_score_) continue;
                const int x = image_.column(i);
                const int y = image_.row(i);
                float shadow_score = 0.0F;
                const int distance = find_shadow(x, y, d, shadow_score);
                const float lack = 1.0F + shadow_score;
                score *= distance == 0 ? 0.0F : std::max(0.9F, 1.0F - lack * lack * lack);
                if (score < min_border_score_) {
                    score = 0.0F;
                } else {
                    candidates.push_back({x, y, static_cast<int>(d), distance});
                }
            }
        }
        return candidates;
    }

    bool is_maximum(const BorderCandidate& candidate) const {
        const std::array<int, 2>& step = steps[static_cast<std::size_t>(candidate.direction)];
        const std::vector<float>& scores = scores_[static_cast<std::size_t>(candidate.direction)];
        const auto score_at = [&](int distance) {
            const int x = candidate.x + distance * step[0];
            const int y = candidate.y + distance * step[1];
            return image_.contains(x, y) ? scores[image_.index(x, y)] : 0.0F;
        };
        const float score = score_at(0);
        if (score_at(-1) > score) return false;
        for (int distance = 1; distance < candidate.shadow_distance; ++distance) {
            if (score_at(distance) > score) return false;
        }
        return true;
    }

    void mark(const BorderCandidate& candidate) {
        const std::array<int, 2>& step = steps[static_cast<std::size_t>(candidate.direction)];
        const auto mark_at = [&](int distance, BorderTrait trait) {
            std::uint8_t& traits = borders_.traits[image_.index(candidate.x + distance * step[0],
                                                                candidate.y + distance * step[1])];
            traits = static_cast<std::uint8_t>(traits | trait);
        };
        mark_at(0, obstacle_border);
        mark_at(candidate.shadow_distance, shadow_border);
        for (int distance = 1; distance < candidate.shadow_distance; ++distance)
            mark_at(distance, veil_point);
        std::array<int, 2>& away = away_[image_.index(candidate.x, candidate.y)];
        away[0] += step[0];
        away[1] += step[1];
    }

    /// Away from the obstacle, within the plane of its surface.
    Eigen::Vector3f border_direction(std::size_t pixel) const {
        const auto [dx, dy] = away_[pixel];
        if (dx == 0 && dy == 0) return Eigen::Vector3f::Zero();
        const Eigen::Vector3f ray =
            image_.projection.direction(image_.column(pixel) + dx, image_.row(pixel) + dy)
                .cast<float>();
        const Eigen::Vector3f& normal = surface_.normals[pixel];
        const Eigen::Vector3f direction = image_.sensor_position +
                                          surface_.plane_offsets[pixel] / normal.dot(ray) * ray -
                                          image_.points[pixel];
        const float length = direction.norm();
        if (!(length > 0.0F) || !std::isfinite(length)) return Eigen::Vector3f::Zero();
        return direction / length;
    }

    /// The mean of a border pixel's direction and those of its like around; zero if it has too few.
    Eigen::Vector3f mean_border_direction(std::size_t pixel,
                                          const std::vector<Eigen::Vector3f>& directions) const {
        constexpr float min_cosine = -0.5F;
        const int x = image_.column(pixel);
        const int y = image_.row(pixel);
        const std::size_t padded = surface_.points.index(x, y);
        const auto down = static_cast<std::ptrdiff_t>(surface_.points.stride);
        Eigen::Vector3f sum = directions[pixel];
        int count = 1;
        for (int dy = -plane_radius; dy <= plane_radius; ++dy) {
            for (int dx = -plane_radius; dx <= plane_radius; ++dx) {
                if ((dx == 0 && dy == 0) || !image_.contains(x + dx, y + dy)) continue;
                const Eigen::Vector3f& other = directions[image_.index(x + dx, y + dy)];
                if (other.isZero(0.0F) || other.dot(directions[pixel]) < min_cosine) continue;
                const float jump = jump_score(pixel, padded, dy * down + dx, 1);
                if (std::abs(jump) >= 0.95F * min_border_score_) continue;
                sum += other;
                ++count;
            }
        }
        if (count <= plane_radius) return Eigen::Vector3f::Zero();
        return sum.normalized();
    }

    void find_border_directions() {
        std::vector<Eigen::Vector3f> directions(image_.size(), Eigen::Vector3f::Zero());
        std::vector<std::size_t> pixels;
        for (std::size_t i = 0; i < image_.size(); ++i) {
            if ((borders_.traits[i] & obstacle_border) == 0) continue;
            directions[i] = border_direction(i);
            if (!directions[i].isZero(0.0F)) pixels.push_back(i);
        }
        for (const std::size_t i : pixels) {
            if (borders_.is_background(i)) continue;
            const Eigen::Vector3f direction = mean_border_direction(i, directions);
            if (direction.isZero(0.0F)) continue;
            borders_.surface_change_scores[i] = 1.0F;
            borders_.surface_change_directions[i] = direction;
        }
    }

    /// The spread of the pixel's normal and those along 8 beams; a beam ends where the surface
    /// does.
    void find_curvature(int x, int y, std::size_t pixel) {
        SymmetricMatrix squares;
        squares.add_square(surface_.normals[pixel]);
        Eigen::Vector3f sum = surface_.normals[pixel];
        float count = 1.0F;
        for (int dy = -1; dy <= 1; ++dy) {
            for (int dx = -1; dx <= 1; ++dx) {
                if (dx == 0 && dy == 0) continue;
                for (int step = 1; step <= curvature_radius; ++step) {
                    const int x2 = x + step * dx;
                    const int y2 = y + step * dy;
                    if (!image_.contains(x2, y2)) break;
                    const std::size_t other = image_.index(x2, y2);
                    if (borders_.is_background(other) && image_.has_range(other)) break;
                    if (!surface_.is_known(other)) continue;
                    const Eigen::Vector3f& normal = surface_.normals[other];
                    squares.add_square(normal);
                    sum += normal;
                    count += 1.0F;
                }
            }
        }
        if (count < 3.0F) return;
        squares.scale(1.0F / count);
        squares.add_square(sum / count, -1.0F);
        if (squares.trace() < min_score * min_score) return;
        const float largest = squares.largest_eigenvalue();
        const float score = std::sqrt(std::max(largest, 0.0F));
        if (score < min_score) return;
        borders_.surface_change_scores[pixel] = score;
        borders_.surface_change_directions[pixel] = squares.eigenvector(largest);
    }

    void find_curvature_in_row(int y) {
        for (int x = 0; x < image_.width; ++x) {
            const std::size_t i = image_.index(x, y);
            if (!surface_.is_known(i) || borders_.is_background(i) ||
                borders_.surface_change_scores[i] > 0.0F) {
                continue;
            }
            find_curvature(x, y, i);
        }
    }

    const RangeImage& image_;
    int radius_;
    float min_border_score_;
    const Context& context_;
    RangeImageSurface surface_;
    Scores raw_scores_ = make_scores();
    Scores scores_ = make_scores();
    /// Sum of the directions in which a pixel is an obstacle's border.
    std::vector<std::array<int, 2>> away_ = std::vector<std::array<int, 2>>(image_.size());
    RangeImageBorders borders_;

    Scores make_scores() const {
        Scores scores;
        scores.fill(std::vector<float>(image_.size(), 0.0F));
        return scores;
    }
};

}  // namespace

RangeImageBorders find_range_image_borders(const RangeImage& image,
                                           const RangeImageBorderSettings& settings,
                                           const Context& context) {
    check_settings(settings);
    return BorderFinder(image, settings, context).find();
}

}  // namespace roomscribe
