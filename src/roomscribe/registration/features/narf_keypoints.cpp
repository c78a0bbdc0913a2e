// SPDX-License-Identifier: MIT
#include "roomscribe/registration/features/narf_keypoints.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include <Eigen/Core>

#include "roomscribe/core/parallel.hpp"
#include "roomscribe/registration/features/narf_bounds.hpp"
#include "roomscribe/registration/features/narf_candidates.hpp"
#include "roomscribe/registration/features/narf_changes.hpp"

namespace roomscribe {
namespace {

constexpr std::size_t strip_rows = 32;
constexpr float rounding = 1e-4F;
constexpr std::size_t max_depth = 34;  // of halving 32 bit numbers of pixels

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
          open_(find_narf_candidates(image, borders, changes_,
                                     {radius_, edge_distance_ * radius_, min_interest_}, context)) {
    }

    std::vector<float> find(const Context& context) {
        interest_.assign(image_.size(), 0.0F);
        const auto rows = static_cast<std::size_t>(image_.height);
        parallel_for(context, rows, strip_rows, [&](std::size_t begin, std::size_t end) {
            Workspace workspace;
            workspace.visited_by.assign(image_.size(), 0);
            workspace.changes.resize(max_depth);
            workspace.begin = image_.index(0, static_cast<int>(begin));
            workspace.end = image_.index(0, static_cast<int>(end));
            for (std::size_t i = workspace.begin; i < workspace.end; ++i) {
                if (open_[i] > 0.0F) find_around({i, image_.column(i), image_.row(i)}, workspace);
            }
        });
        return std::move(interest_);
    }

  private:
    struct Pixel {
        std::size_t index;
        int x;
        int y;
        float steadiness = 1.0F;  ///< at most
    };

    /// What counts for some pixels.
    struct Changes {
        std::vector<NearChange> all;
        std::vector<NearChange> edges;  ///< that may spoil the interest, as if of one direction
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
        std::vector<Changes> changes;     ///< per depth of the division of the near pixels
    };

    /// The interest of all candidates within a quarter of the support size of a seed, from the
    /// changes within three quarters that the surface reaches without leaving that ball.
    void find_around(const Pixel& seed, Workspace& work) {
        grow(seed, work);
        Changes& changes = work.changes[0];
        changes.all.clear();
        changes.edges.clear();
        const float edge_reach = (0.5F + edge_distance_) * radius_;
        for (const std::size_t i : work.around) {
            const Eigen::Vector3f& point = image_.points[i];
            const Eigen::Array4f position = PointBox::position(point);
            changes.all.push_back({position, scores_[i], changes_.angles[i]});
            if ((point - image_.points[seed.index]).squaredNorm() <= edge_reach * edge_reach) {
                changes.edges.push_back({position, scores_[i], 0});
            }
        }
        for (const Pixel& pixel : work.near)
            open_[pixel.index] = 0.0F;
        divide(work.near, work, 0);
    }

    /// Sets the interest of pixels, given the changes that count for them.
    void divide(std::span<Pixel> pixels, Workspace& work, std::size_t depth) {
        PointBox box;
        NarfBounds bounds;
        float steadiness = 0.0F;
        for (const Pixel& pixel : pixels) {
            box.extend(image_.points[pixel.index]);
            steadiness = std::max(steadiness, pixel.steadiness);
            // The 3 x 3 pixels count in full.
            for_beside(pixel, [&](const Pixel& other) {
                if (!changes_.has_change(other.index)) return;
                float& most = bounds.most[changes_.angles[other.index]];
                most = std::max(most, scores_[other.index]);
            });
        }
        const Changes& changes = work.changes[depth];
        Changes& kept = work.changes[depth + 1];
        bounds.add(changes.all, box, radius_, kept.all);
        const float root = min_interest_ / steadiness;
        AngleHistogram least;
        const float best = bounds.best_pair(root * root, least);
        if (best < root * root * (1.0F - rounding)) return;
        NarfBounds edge;
        edge.add(changes.edges, box, edge_distance_ * radius_, kept.edges);
        steadiness = std::min(steadiness, narf_steadiness(edge.sure[0]));
        const float interest = steadiness * std::sqrt(best);
        if (interest < min_interest_ - rounding) return;
        if (pixels.size() == 1) {
            interest_[pixels.front().index] = interest;
            return;
        }
        drop_weak(least, kept.all);
        edge.best_pair(0.0F, least);
        drop_weak(least, kept.edges);
        const std::size_t half = split(pixels, box);
        divide(pixels.first(half), work, depth + 1);
        divide(pixels.subspan(half), work, depth + 1);
    }

    /// Halves pixels where their box is longest; returns the size of the first half.
    std::size_t split(std::span<Pixel> pixels, const PointBox& box) const {
        Eigen::Index axis = 0;
        (box.high - box.low).maxCoeff(&axis);
        const std::size_t half = pixels.size() / 2;
        std::nth_element(pixels.begin(), pixels.begin() + static_cast<std::ptrdiff_t>(half),
                         pixels.end(), [&](const Pixel& a, const Pixel& b) {
                             return image_.points[a.index][axis] < image_.points[b.index][axis];
                         });
        return half;
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
                open_[i] > 0.0F) {
                work.near.push_back({i, pixel.x, pixel.y, open_[i]});
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
    std::vector<float> open_;  ///< steadiness of candidates whose interest is not yet known
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
