// SPDX-License-Identifier: MIT
#include "roomscribe/registration/features/narf_keypoints.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>

#include "roomscribe/core/parallel.hpp"

namespace roomscribe {
namespace {

constexpr std::size_t num_angles = 18;
constexpr std::size_t strip_rows = 32;

/// Strongest change of the surface per direction.
using AngleHistogram = std::array<float, num_angles>;

/// Changes of the surface of one direction, as columns x, y, z and score.
class ChangeList {
  public:
    void clear() { count_ = 0; }
    void add(const Eigen::Vector3f& position, float score) {
        if (count_ == values_.rows()) values_.conservativeResize(2 * count_ + 64, Eigen::NoChange);
        values_.row(count_++) << position.x(), position.y(), position.z(), score;
    }
    /// The most of score * (1 - distance / radius) over the changes; 0 without any.
    float most_at(const Eigen::Vector3f& point, float radius) const {
        if (count_ == 0) return 0.0F;
        const auto changes = values_.topRows(count_);
        const auto distances =
            ((changes.col(0) - point.x()).square() + (changes.col(1) - point.y()).square() +
             (changes.col(2) - point.z()).square())
                .sqrt();
        return std::max(0.0F, (changes.col(3) * (1.0F - distances * (1.0F / radius))).maxCoeff());
    }

  private:
    Eigen::Array<float, Eigen::Dynamic, 4> values_;
    Eigen::Index count_ = 0;
};

class InterestFinder {
  public:
    InterestFinder(const RangeImage& image, const RangeImageBorders& borders,
                   const NarfKeypointSettings& settings)
        : image_(image),
          borders_(borders),
          radius_(static_cast<float>(0.5 * settings.support_size)),
          min_interest_(static_cast<float>(settings.min_interest)),
          edge_distance_(static_cast<float>(settings.edge_distance)),
          min_change_(static_cast<float>(settings.min_surface_change)) {}

    std::vector<float> find(const Context& context) {
        angles_.assign(image_.size(), no_angle);
        is_surface_.assign(image_.size(), 1);
        interest_.assign(image_.size(), unknown);
        const auto rows = static_cast<std::size_t>(image_.height);
        parallel_for(context, rows, strip_rows, [&](std::size_t begin, std::size_t end) {
            find_angles(image_.index(0, static_cast<int>(begin)),
                        image_.index(0, static_cast<int>(end)));
        });
        dismiss_blocks();
        parallel_for(context, rows, strip_rows, [&](std::size_t begin, std::size_t end) {
            Workspace workspace;
            workspace.visited_by.assign(image_.size(), 0);
            workspace.begin = image_.index(0, static_cast<int>(begin));
            workspace.end = image_.index(0, static_cast<int>(end));
            for (std::size_t i = workspace.begin; i < workspace.end; ++i) {
                if (interest_[i] == unknown) {
                    find_around({i, image_.column(i), image_.row(i)}, workspace);
                }
            }
        });
        return std::move(interest_);
    }

  private:
    static constexpr std::uint8_t no_angle = 255;
    static constexpr float unknown = 2.0F;

    struct Pixel {
        std::size_t index;
        int x;
        int y;
    };

    /// Of one strip of the image, which is its own whatever other threads do.
    struct Workspace {
        std::size_t begin = 0;
        std::size_t end = 0;
        std::uint32_t visit = 0;
        std::vector<std::uint32_t> visited_by;
        std::vector<Pixel> queue;
        std::vector<Pixel> near;          ///< of the strip, which the seed answers for
        std::vector<std::size_t> around;  ///< where the surface changes
        AngleHistogram most;              ///< bounds, for all pixels that are near
        std::array<ChangeList, num_angles> changes;
        ChangeList strong_changes;  ///< without one of them no interest is enough
        ChangeList near_changes;    ///< that may be an edge beside a near pixel
    };

    /// Direction of a change as the scanner sees it, in steps of 10 degrees; a direction and its
    /// opposite are the same.
    void find_angles(std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (!image_.has_range(i) || borders_.is_background(i)) {
                interest_[i] = 0.0F;
                is_surface_[i] = 0;
                continue;
            }
            if (borders_.surface_change_scores[i] < min_change_) continue;
            const Eigen::Vector3f ray = image_.points[i] - image_.sensor_position;
            const Eigen::Vector3f right = image_.up.cross(ray);
            const Eigen::Vector3f above = ray.cross(right);
            const Eigen::Vector3f& direction = borders_.surface_change_directions[i];
            const float x = direction.dot(right) * ray.norm();
            const float y = direction.dot(above);
            constexpr float pi = std::numbers::pi_v<float>;
            const float angle = std::atan2(y, x) + (y < 0.0F ? pi : 0.0F);  // [0, pi]
            const auto cell = static_cast<int>(angle / pi * static_cast<float>(num_angles));
            angles_[i] = static_cast<std::uint8_t>(cell % static_cast<int>(num_angles));
        }
    }

    /// Sets the interest of blocks of pixels to 0 that have no strong change near enough: one of
    /// the two changes that make a keypoint is at least as much as its interest.
    void dismiss_blocks() {
        if (image_.projection.kind == RangeProjection::Kind::longitude_by_row) return;
        const auto row_size = static_cast<std::size_t>(image_.width) + 1;
        std::vector<std::uint32_t> num_strong(row_size * static_cast<std::size_t>(image_.height));
        for (int y = 0; y < image_.height; ++y) {
            std::uint32_t* counts = &num_strong[row_size * static_cast<std::size_t>(y)];
            for (int x = 0; x < image_.width; ++x) {
                const bool is_strong =
                    borders_.surface_change_scores[image_.index(x, y)] >= min_interest_;
                counts[x + 1] = counts[x] + (is_strong ? 1U : 0U);
            }
        }
        constexpr int side = 8;
        for (int top = 0; top < image_.height; top += side) {
            for (int left = 0; left < image_.width; left += side) {
                const Block block{left, top, std::min(left + side, image_.width) - 1,
                                  std::min(top + side, image_.height) - 1};
                if (!has_strong_change(block, num_strong)) dismiss(block);
            }
        }
    }

    struct Block {
        int left, top, right, bottom;  ///< all inclusive
    };

    void dismiss(const Block& block) {
        for (int y = block.top; y <= block.bottom; ++y) {
            for (int x = block.left; x <= block.right; ++x)
                interest_[image_.index(x, y)] = 0.0F;
        }
    }

    /// True unless no pixel within reach of the block's has a strong change. What is seen within an
    /// angle of a direction lies between known latitudes and longitudes.
    bool has_strong_change(const Block& block, const std::vector<std::uint32_t>& num_strong) const {
        float range = RangeImage::far;
        for (int y = block.top; y <= block.bottom; ++y) {
            for (int x = block.left; x <= block.right; ++x) {
                const std::size_t i = image_.index(x, y);
                if (interest_[i] == unknown) range = std::min(range, image_.ranges[i]);
            }
        }
        if (range == RangeImage::far) return true;
        const double reach = (1.0 - min_interest_) * radius_ / range;
        if (reach >= 1.0) return true;
        const RangeProjection& projection = image_.projection;
        const bool is_sinusoidal = projection.kind == RangeProjection::Kind::sinusoidal;
        // One pixel is the reach beyond all distances, one is for rounding.
        const int margin =
            static_cast<int>(std::ceil(std::asin(reach) / std::abs(projection.step_y))) + 2;
        const auto cos_latitude = [&](int y) {
            return std::cos(projection.first_y + projection.step_y * y);
        };
        const double least_cosine = std::min(cos_latitude(block.top), cos_latitude(block.bottom));
        if (reach >= least_cosine) return true;
        const double turn = std::asin(reach / least_cosine);
        const auto angle = [&](int x) { return projection.first_x + projection.step_x * x; };
        const auto [low, high] = std::minmax({angle(block.left), angle(block.right)});
        const double most_cosine =
            is_sinusoidal ? std::max(cos_latitude(block.top), cos_latitude(block.bottom)) : 1.0;
        const double divisor = is_sinusoidal ? least_cosine : 1.0;
        const double west = (low < 0.0 ? low / divisor : low / most_cosine) - turn;
        const double east = (high > 0.0 ? high / divisor : high / most_cosine) + turn;
        const auto row_size = static_cast<std::size_t>(image_.width) + 1;
        for (int y = std::max(block.top - margin, 0);
             y <= std::min(block.bottom + margin, image_.height - 1); ++y) {
            const double scale = is_sinusoidal ? cos_latitude(y) : 1.0;
            const auto [a, b] =
                std::minmax({(west * scale - projection.first_x) / projection.step_x,
                             (east * scale - projection.first_x) / projection.step_x});
            const double last = image_.width;
            const auto begin = static_cast<std::size_t>(std::clamp(std::floor(a) - 2.0, 0.0, last));
            const auto end = static_cast<std::size_t>(std::clamp(std::ceil(b) + 3.0, 0.0, last));
            const std::uint32_t* counts = &num_strong[row_size * static_cast<std::size_t>(y)];
            if (end > begin && counts[end] > counts[begin]) return true;
        }
        return false;
    }

    /// The interest of all pixels within a quarter of the support size of a seed, from the changes
    /// within three quarters that the surface reaches without leaving that ball.
    void find_around(const Pixel& seed, Workspace& work) {
        grow(seed, work);
        if (angle_change(work.most) < min_interest_) {
            for (const Pixel& pixel : work.near)
                interest_[pixel.index] = 0.0F;
            return;
        }
        sort_changes(seed, work);
        for (const Pixel& pixel : work.near) {
            float& value = interest_[pixel.index];
            if (value == unknown) value = interest(pixel, work);
        }
    }

    void sort_changes(const Pixel& seed, Workspace& work) const {
        work.strong_changes.clear();
        work.near_changes.clear();
        for (ChangeList& list : work.changes)
            list.clear();
        const float most = *std::max_element(work.most.begin(), work.most.end());
        const float edge_reach = (0.5F + edge_distance_) * radius_;
        for (const std::size_t i : work.around) {
            const Eigen::Vector3f& point = image_.points[i];
            const float score = borders_.surface_change_scores[i];
            if (most * work.most[angles_[i]] >= min_interest_ * min_interest_) {
                work.changes[angles_[i]].add(point, score);
            }
            if (score >= min_interest_) work.strong_changes.add(point, score);
            if ((point - image_.points[seed.index]).squaredNorm() <= edge_reach * edge_reach) {
                work.near_changes.add(point, score);
            }
        }
    }

    void grow(const Pixel& seed, Workspace& work) const {
        const float reach = 1.5F * radius_;
        const float near_reach = 0.5F * radius_;
        const Eigen::Vector3f center = image_.points[seed.index];
        const float pixel_size = image_.ranges[seed.index] *
                                 static_cast<float>(std::max(std::abs(image_.projection.step_x),
                                                             std::abs(image_.projection.step_y)));
        // A change beside a pixel counts in full, however far it is.
        const bool is_sparse = 3.0F * pixel_size > radius_;
        work.near.clear();
        work.around.clear();
        work.most.fill(0.0F);
        work.queue.assign(1, seed);
        ++work.visit;
        work.visited_by[seed.index] = work.visit;
        for (std::size_t next = 0; next < work.queue.size(); ++next) {
            const Pixel pixel = work.queue[next];
            const std::size_t i = pixel.index;
            const float squared_distance = (image_.points[i] - center).squaredNorm();
            if (squared_distance <= near_reach * near_reach && i >= work.begin && i < work.end) {
                work.near.push_back(pixel);
            }
            // The pixels beside the seed count however far apart the pixels are.
            const bool is_beside =
                std::max(std::abs(pixel.x - seed.x), std::abs(pixel.y - seed.y)) <= 2;
            if (!is_beside && squared_distance > reach * reach) continue;
            if (angles_[i] != no_angle) {
                work.around.push_back(i);
                const float nearness =
                    is_sparse ? 1.0F : std::min(1.0F, 1.5F - std::sqrt(squared_distance) / radius_);
                float& most = work.most[angles_[i]];
                most = std::max(most, nearness * borders_.surface_change_scores[i]);
            }
            for (int y = std::max(pixel.y - 1, 0); y <= std::min(pixel.y + 1, image_.height - 1);
                 ++y) {
                for (int x = std::max(pixel.x - 1, 0); x <= std::min(pixel.x + 1, image_.width - 1);
                     ++x) {
                    const std::size_t other = image_.index(x, y);
                    if (work.visited_by[other] == work.visit) continue;
                    work.visited_by[other] = work.visit;
                    if (is_surface_[other] != 0) work.queue.push_back({other, x, y});
                }
            }
        }
    }

    static float angle_change(const AngleHistogram& histogram) {
        float most = 0.0F;
        for (std::size_t a = 0; a + 1 < num_angles; ++a) {
            if (histogram[a] <= most) continue;  // no product with it can be more
            for (std::size_t b = a + 1; b < num_angles; ++b) {
                const float difference = 2.0F * static_cast<float>(b - a) / num_angles;
                most = std::max(
                    most, histogram[a] * histogram[b] * std::min(difference, 2.0F - difference));
            }
        }
        return std::sqrt(most);
    }

    /// What a change at some nearness to a pixel leaves of its interest.
    static float steadiness(float edge) { return (1.0F - 0.5F * edge) * (1.0F - 0.5F * edge); }

    float interest(const Pixel& pixel, const Workspace& work) const {
        if (steadiness(borders_.surface_change_scores[pixel.index]) < min_interest_) return 0.0F;
        AngleHistogram histogram{};
        add_beside(pixel, work, histogram);
        const Eigen::Vector3f& point = image_.points[pixel.index];
        // The two changes are at most 1, so one of them is at least the interest.
        if (*std::max_element(histogram.begin(), histogram.end()) < min_interest_ &&
            work.strong_changes.most_at(point, radius_) < min_interest_) {
            return 0.0F;
        }
        const float steady = steadiness(work.near_changes.most_at(point, edge_distance_ * radius_));
        if (steady < min_interest_) return 0.0F;
        for (std::size_t angle = 0; angle < num_angles; ++angle) {
            histogram[angle] =
                std::max(histogram[angle], work.changes[angle].most_at(point, radius_));
        }
        return steady * angle_change(histogram);
    }

    /// The 3 x 3 pixels count in full.
    void add_beside(const Pixel& pixel, const Workspace& work, AngleHistogram& histogram) const {
        for (int y = std::max(pixel.y - 1, 0); y <= std::min(pixel.y + 1, image_.height - 1); ++y) {
            for (int x = std::max(pixel.x - 1, 0); x <= std::min(pixel.x + 1, image_.width - 1);
                 ++x) {
                const std::size_t other = image_.index(x, y);
                if (angles_[other] == no_angle || work.visited_by[other] != work.visit) continue;
                float& value = histogram[angles_[other]];
                value = std::max(value, borders_.surface_change_scores[other]);
            }
        }
    }

    const RangeImage& image_;
    const RangeImageBorders& borders_;
    float radius_;
    float min_interest_;
    float edge_distance_;
    float min_change_;
    std::vector<std::uint8_t> angles_;
    std::vector<std::uint8_t> is_surface_;  ///< has a range that is neither shadow nor veil
    std::vector<float> interest_;
};

bool is_local_maximum(const RangeImage& image, const std::vector<float>& interest,
                      std::size_t pixel) {
    const int x = image.column(pixel);
    const int y = image.row(pixel);
    for (int y2 = std::max(y - 1, 0); y2 <= std::min(y + 1, image.height - 1); ++y2) {
        for (int x2 = std::max(x - 1, 0); x2 <= std::min(x + 1, image.width - 1); ++x2) {
            if (interest[image.index(x2, y2)] > interest[pixel]) return false;
        }
    }
    return true;
}

}  // namespace

std::vector<float> compute_narf_interest(const RangeImage& image, const RangeImageBorders& borders,
                                         const NarfKeypointSettings& settings,
                                         const Context& context) {
    check_settings(settings);
    return InterestFinder(image, borders, settings).find(context);
}

std::vector<NarfKeypoint> detect_narf_keypoints(const RangeImage& image,
                                                const NarfKeypointSettings& settings,
                                                const Context& context) {
    const RangeImageBorders borders = find_range_image_borders(image, settings.borders, context);
    const std::vector<float> interest = compute_narf_interest(image, borders, settings, context);
    std::vector<std::uint32_t> candidates;
    for (std::uint32_t i = 0; i < interest.size(); ++i) {
        if (interest[i] >= settings.min_interest && is_local_maximum(image, interest, i)) {
            candidates.push_back(i);
        }
    }
    std::stable_sort(candidates.begin(), candidates.end(),
                     [&](auto a, auto b) { return interest[a] > interest[b]; });
    const auto distance = static_cast<float>(settings.min_distance * settings.support_size);
    std::vector<NarfKeypoint> keypoints;
    for (const std::uint32_t i : candidates) {
        if (settings.max_keypoints > 0 &&
            keypoints.size() == static_cast<std::size_t>(settings.max_keypoints)) {
            break;
        }
        const Eigen::Vector3f& position = image.points[i];
        const bool is_too_near =
            std::any_of(keypoints.begin(), keypoints.end(), [&](const NarfKeypoint& better) {
                return (better.position - position).squaredNorm() < distance * distance;
            });
        if (!is_too_near) keypoints.push_back({i, position, interest[i]});
    }
    return keypoints;
}

}  // namespace roomscribe
