// SPDX-License-Identifier: MIT
#include "roomscribe/registration/correspondences.hpp"

#include <algorithm>
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
/// its leaves; blocks of matrix products are faster.
std::vector<Nearest> find_nearest(const Eigen::Ref<const Eigen::MatrixXf>& queries,
                                  const Eigen::Ref<const Eigen::MatrixXf>& data,
                                  const Context& context) {
    constexpr Eigen::Index data_block = 512;
    const Eigen::VectorXf data_norms = data.colwise().squaredNorm();
    std::vector<Nearest> nearest(static_cast<std::size_t>(queries.cols()));
    parallel_for(context, nearest.size(), 64, [&](std::size_t begin, std::size_t end) {
        const auto block = queries.middleCols(static_cast<Eigen::Index>(begin),
                                              static_cast<Eigen::Index>(end - begin));
        Eigen::MatrixXf products;
        for (Eigen::Index first = 0; first < data.cols(); first += data_block) {
            const Eigen::Index count = std::min(data_block, data.cols() - first);
            products.noalias() = data.middleCols(first, count).transpose() * block;
            for (Eigen::Index query = 0; query < block.cols(); ++query) {
                Eigen::Index best = 0;
                const float score =
                    (data_norms.segment(first, count) - 2.0F * products.col(query)).minCoeff(&best);
                Nearest& entry = nearest[begin + static_cast<std::size_t>(query)];
                if (score < entry.squared_distance) {
                    entry = {static_cast<std::uint32_t>(first + best), score};
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
