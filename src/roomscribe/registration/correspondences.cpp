// SPDX-License-Identifier: MIT
#include "roomscribe/registration/correspondences.hpp"

#include <cmath>
#include <limits>

#include "roomscribe/core/error.hpp"
#include "roomscribe/core/parallel.hpp"

namespace roomscribe {
namespace {

struct Nearest {
    std::uint32_t index = 0;
    float squared_distance = std::numeric_limits<float>::max();
};

/// For every query column the nearest data column. In so many dimensions a k-d tree visits most of
/// its leaves; blocks of matrix products are faster. |d|^2 - 2 q.d cancels most of its digits, so
/// what comes out as near as rounding can tell is measured again, term by term.
std::vector<Nearest> find_nearest(const Eigen::Ref<const Eigen::MatrixXf>& queries,
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
                if (squared_distance < entry.squared_distance) {
                    entry = {static_cast<std::uint32_t>(i), squared_distance};
                }
            }
        }
    });
    return nearest;
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

    const std::vector<Nearest> forth = find_nearest(source, target, context);
    std::vector<Nearest> back;
    if (settings.method == MatchMethod::back_and_forth) {
        back = find_nearest(target, source, context);
    }
    for (std::uint32_t i = 0; i < forth.size(); ++i) {
        const std::uint32_t match = forth[i].index;
        if (!back.empty() && back[match].index != i) continue;
        matches.push_back({i, match, (source.col(i) - target.col(match)).norm()});
    }
    return matches;
}

}  // namespace roomscribe
