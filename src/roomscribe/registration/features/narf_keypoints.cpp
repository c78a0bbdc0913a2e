// SPDX-License-Identifier: MIT
#include "roomscribe/registration/features/narf_keypoints.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/Core>

#include "roomscribe/core/parallel.hpp"
#include "roomscribe/registration/features/narf_candidates.hpp"
#include "roomscribe/registration/features/narf_changes.hpp"

namespace roomscribe {
namespace {

constexpr std::size_t strip_rows = 32;

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
                   const NarfKeypointSettings& settings, const Context& context)
        : image_(image),
          scores_(borders.surface_change_scores),
          radius_(static_cast<float>(0.5 * settings.support_size)),
          min_interest_(static_cast<float>(settings.min_interest)),
          edge_distance_(static_cast<float>(settings.edge_distance)),
          changes_(find_narf_changes(image, borders,
                                     static_cast<float>(settings.min_surface_change), context)),
          is_open_(find_narf_candidates(image, borders, changes_,
                                        {radius_, edge_distance_ * radius_, min_interest_},
                                        context)) {}

    std::vector<float> find(const Context& context) {
        interest_.assign(image_.size(), 0.0F);
        const auto rows = static_cast<std::size_t>(image_.height);
        parallel_for(context, rows, strip_rows, [&](std::size_t begin, std::size_t end) {
            Workspace workspace;
            workspace.visited_by.assign(image_.size(), 0);
            workspace.begin = image_.index(0, static_cast<int>(begin));
            workspace.end = image_.index(0, static_cast<int>(end));
            for (std::size_t i = workspace.begin; i < workspace.end; ++i) {
                if (is_open_[i] != 0) find_around({i, image_.column(i), image_.row(i)}, workspace);
            }
        });
        return std::move(interest_);
    }

  private:
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
        std::array<ChangeList, num_change_angles> changes;
        ChangeList near_changes;  ///< that may be an edge beside a near pixel
    };

    /// The interest of all candidates within a quarter of the support size of a seed, from the
    /// changes within three quarters that the surface reaches without leaving that ball.
    void find_around(const Pixel& seed, Workspace& work) {
        grow(seed, work);
        sort_changes(seed, work);
        for (const Pixel& pixel : work.near) {
            interest_[pixel.index] = interest(pixel, work);
            is_open_[pixel.index] = 0;
        }
    }

    void sort_changes(const Pixel& seed, Workspace& work) const {
        work.near_changes.clear();
        for (ChangeList& list : work.changes)
            list.clear();
        const float edge_reach = (0.5F + edge_distance_) * radius_;
        for (const std::size_t i : work.around) {
            const Eigen::Vector3f& point = image_.points[i];
            work.changes[changes_.angles[i]].add(point, scores_[i]);
            if ((point - image_.points[seed.index]).squaredNorm() <= edge_reach * edge_reach) {
                work.near_changes.add(point, scores_[i]);
            }
        }
    }

    void grow(const Pixel& seed, Workspace& work) const {
        const float reach = 1.5F * radius_;
        const float near_reach = 0.5F * radius_;
        const Eigen::Vector3f center = image_.points[seed.index];
        work.near.clear();
        work.around.clear();
        work.queue.assign(1, seed);
        ++work.visit;
        work.visited_by[seed.index] = work.visit;
        for (std::size_t next = 0; next < work.queue.size(); ++next) {
            const Pixel pixel = work.queue[next];
            const std::size_t i = pixel.index;
            const float squared_distance = (image_.points[i] - center).squaredNorm();
            if (squared_distance <= near_reach * near_reach && i >= work.begin && i < work.end &&
                is_open_[i] != 0) {
                work.near.push_back(pixel);
            }
            // The pixels beside the seed count however far apart the pixels are.
            const bool is_beside =
                std::max(std::abs(pixel.x - seed.x), std::abs(pixel.y - seed.y)) <= 2;
            if (!is_beside && squared_distance > reach * reach) continue;
            if (changes_.has_change(i)) work.around.push_back(i);
            for_beside(pixel, [&](const Pixel& other) {
                if (work.visited_by[other.index] == work.visit) return;
                work.visited_by[other.index] = work.visit;
                if (changes_.is_surface[other.index] != 0) work.queue.push_back(other);
            });
        }
    }

    static float angle_change(const AngleHistogram& histogram) {
        float most = 0.0F;
        for (std::size_t a = 0; a + 1 < num_change_angles; ++a) {
            if (histogram[a] <= most) continue;  // no product with it can be more
            for (std::size_t b = a + 1; b < num_change_angles; ++b)
                most = std::max(most, histogram[a] * histogram[b] * angle_difference(a, b));
        }
        return std::sqrt(most);
    }

    float interest(const Pixel& pixel, const Workspace& work) const {
        const Eigen::Vector3f& point = image_.points[pixel.index];
        const float edge = work.near_changes.most_at(point, edge_distance_ * radius_);
        const float steadiness = narf_steadiness(edge);
        if (steadiness < min_interest_) return 0.0F;
        // The 3 x 3 pixels count in full.
        AngleHistogram histogram{};
        for_beside(pixel, [&](const Pixel& other) {
            if (!changes_.has_change(other.index)) return;
            float& value = histogram[changes_.angles[other.index]];
            value = std::max(value, scores_[other.index]);
        });
        for (std::size_t angle = 0; angle < num_change_angles; ++angle) {
            histogram[angle] =
                std::max(histogram[angle], work.changes[angle].most_at(point, radius_));
        }
        return steadiness * angle_change(histogram);
    }

    /// Calls visit(pixel) for the 3 x 3 pixels.
    template <typename Visit>
    void for_beside(const Pixel& pixel, Visit&& visit) const {
        const int right = std::min(pixel.x + 1, image_.width - 1);
        const int bottom = std::min(pixel.y + 1, image_.height - 1);
        for (int y = std::max(pixel.y - 1, 0); y <= bottom; ++y) {
            for (int x = std::max(pixel.x - 1, 0); x <= right; ++x)
                visit(Pixel{image_.index(x, y), x, y});
        }
    }

    const RangeImage& image_;
    const std::vector<float>& scores_;
    float radius_;
    float min_interest_;
    float edge_distance_;
    NarfChanges changes_;
    std::vector<std::uint8_t> is_open_;  ///< is a candidate whose interest is not yet known
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
    return InterestFinder(image, borders, settings, context).find(context);
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
