// SPDX-License-Identifier: MIT
#include "roomscribe/registration/features/correspondences.hpp"

#include <cmath>
#include <cstddef>
#include <limits>

#include <nanoflann.hpp>

#include "roomscribe/core/error.hpp"
#include "roomscribe/core/parallel.hpp"

namespace roomscribe {
namespace {

struct Nearest {
    std::uint32_t index = 0;
    float distance = std::numeric_limits<float>::max();  ///< squared if Euclidean
};

/// For every query column the nearest data column. In so many dimensions a k-d tree visits most of
/// its leaves; blocks of matrix products are faster. |d|^2 - 2 q.d cancels most of its digits, so
/// what comes out as near as rounding can tell is measured again, term by term.
std::vector<Nearest> find_nearest_euclidean(const Eigen::Ref<const Eigen::MatrixXf>& queries,
                                            const Eigen::Ref<const Eigen::MatrixXf>& data,
                                            const Context& context) {
    const Eigen::VectorXf data_norms = data.colwise().squaredNorm();
    const float rounding = 1e-5F * data_norms.maxCoeff();
    std::vector<Nearest> nearest(static_cast<std::size_t>(queries.cols()));
    parallel_for(context, nearest.size(), 32, [&](std::size_t begin, std::size_t end) {
        const auto first = static_cast<Eigen::Index>(begin);
        const Eigen::MatrixXf scores =
            (data.transpose() * queries.middleCols(first, static_cast<Eigen::Index>(end - begin)) *
             -2.0F)
                .colwise() +
            data_norms;
        for (Eigen::Index query = 0; query < scores.cols(); ++query) {
            const float limit = scores.col(query).minCoeff() + rounding;
            Nearest& entry = nearest[begin + static_cast<std::size_t>(query)];
            for (Eigen::Index i = 0; i < data.cols(); ++i) {
                if (scores(i, query) > limit) continue;
                const float squared_distance =
                    (queries.col(first + query) - data.col(i)).squaredNorm();
                if (squared_distance < entry.distance) {
                    entry = {static_cast<std::uint32_t>(i), squared_distance};
                }
            }
        }
    });
    return nearest;
}

/// Columns as nanoflann wants them.
struct DescriptorSet {
    const Eigen::Ref<const Eigen::MatrixXf>& columns;

    // The names are nanoflann's.
    std::size_t kdtree_get_point_count() const { return static_cast<std::size_t>(columns.cols()); }
    float kdtree_get_pt(std::size_t index, std::size_t dimension) const {
        return columns(static_cast<Eigen::Index>(dimension), static_cast<Eigen::Index>(index));
    }
    template <typename Box>
    bool kdtree_get_bbox(Box&) const {
        return false;
    }
};

/// Keeps the nearest, of equally near ones the one of the lowest number in whatever order they
/// come.
class NearestResult {
  public:
    using DistanceType = float;

    std::size_t size() const { return 1; }
    bool full() const { return true; }
    float worstDist() const {
        return std::nextafter(nearest.distance, std::numeric_limits<float>::infinity());
    }
    bool addPoint(float distance, std::uint32_t index) {
        if (distance < nearest.distance ||
            (distance == nearest.distance && index < nearest.index)) {
            nearest = {index, distance};
        }
        return true;
    }

    Nearest nearest;
};

/// For every query column the nearest data column, by a k-d tree in the space of the descriptors.
std::vector<Nearest> find_nearest_manhattan(const Eigen::Ref<const Eigen::MatrixXf>& queries,
                                            const Eigen::Ref<const Eigen::MatrixXf>& data,
                                            const Context& context) {
    using Metric = nanoflann::L1_Adaptor<float, DescriptorSet, float, std::uint32_t>;
    using Tree = nanoflann::KDTreeSingleIndexAdaptor<Metric, DescriptorSet, -1, std::uint32_t>;
    const DescriptorSet set{data};
    const Tree tree(static_cast<int>(data.rows()), set);
    std::vector<Nearest> nearest(static_cast<std::size_t>(queries.cols()));
    parallel_for(context, nearest.size(), 32, [&](std::size_t begin, std::size_t end) {
        Eigen::VectorXf query(queries.rows());
        for (std::size_t i = begin; i < end; ++i) {
            query = queries.col(static_cast<Eigen::Index>(i));
            NearestResult result;
            tree.findNeighbors(result, query.data(), nanoflann::SearchParams());
            nearest[i] = result.nearest;
        }
    });
    return nearest;
}

std::vector<Nearest> find_nearest(const Eigen::Ref<const Eigen::MatrixXf>& queries,
                                  const Eigen::Ref<const Eigen::MatrixXf>& data,
                                  DescriptorMetric metric, const Context& context) {
    return metric == DescriptorMetric::euclidean ? find_nearest_euclidean(queries, data, context)
                                                 : find_nearest_manhattan(queries, data, context);
}

float descriptor_distance(const Eigen::Ref<const Eigen::VectorXf>& a,
                          const Eigen::Ref<const Eigen::VectorXf>& b, DescriptorMetric metric) {
    return metric == DescriptorMetric::euclidean ? (a - b).norm() : (a - b).lpNorm<1>();
}

}  // namespace

std::vector<Correspondence> match_descriptors(const Eigen::Ref<const Eigen::MatrixXf>& source,
                                              const Eigen::Ref<const Eigen::MatrixXf>& target,
                                              const MatchSettings& settings,
                                              const Context& context) {
    check_settings(settings);
    if (source.rows() != target.rows()) {
        throw InvalidArgument("descriptor size", std::to_string(source.rows()),
                              "the same for source and target");
    }
    std::vector<Correspondence> matches;
    if (source.cols() == 0 || target.cols() == 0) return matches;

    const std::vector<Nearest> forth = find_nearest(source, target, settings.metric, context);
    std::vector<Nearest> back;
    if (settings.method == MatchMethod::back_and_forth) {
        back = find_nearest(target, source, settings.metric, context);
    }
    for (std::uint32_t i = 0; i < forth.size(); ++i) {
        const std::uint32_t match = forth[i].index;
        if (!back.empty() && back[match].index != i) continue;
        matches.push_back(
            {i, match, descriptor_distance(source.col(i), target.col(match), settings.metric)});
    }
    return matches;
}

}  // namespace roomscribe
