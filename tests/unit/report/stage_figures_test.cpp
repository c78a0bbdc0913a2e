// SPDX-License-Identifier: MIT
#include "roomscribe/report/stage_figures.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace roomscribe {
namespace {

using testing::HasSubstr;

OutlinedPatch square(const Eigen::Vector3d& normal, float z) {
    OutlinedPatch patch;
    patch.normal = normal;
    for (int i = 0; i <= 40; ++i)
        for (int k = 0; k <= 40; ++k)
            patch.points.emplace_back(0.1F * static_cast<float>(i), 0.1F * static_cast<float>(k),
                                      z);
    const Eigen::Vector3f a(0, 0, z), b(4, 0, z), c(4, 4, z), d(0, 4, z);
    patch.boundary = {a, b, c, d};
    patch.lines = {{a, b}, {b, c}};
    patch.rectangles = {{a, b, c, d}};
    return patch;
}

Reconstruction floor_and_ceiling() {
    Reconstruction result;
    result.patches = {square(Eigen::Vector3d::UnitZ(), 0.0F),
                      square(-Eigen::Vector3d::UnitZ(), 2.5F)};
    for (const OutlinedPatch& patch : result.patches) {
        result.map.cloud.positions.insert(result.map.cloud.positions.end(), patch.points.begin(),
                                          patch.points.end());
    }
    return result;
}

std::size_t count(const std::string& text, const std::string& word) {
    std::size_t found = 0;
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1))
        ++found;
    return found;
}

TEST(StageFigures, DrawWhatFacesTheViewer) {
    const std::string html = stage_figures(floor_and_ceiling(), {});
    EXPECT_EQ(count(html, "<figure>"), 4U);
    EXPECT_THAT(html, HasSubstr("2 planar patches"));
    EXPECT_THAT(html, HasSubstr("4 straight stretches"));
    EXPECT_THAT(html, HasSubstr("2 rectangles"));
    // The floor's lines and rectangle; the ceiling turns its back.
    EXPECT_EQ(count(html, "class=\"stage-line\""), 2U);
    EXPECT_EQ(count(html, "Z\"/>"), 1U);
}

TEST(StageFigures, AreLeftOutWithoutPatches) {
    EXPECT_EQ(stage_figures({}, {}), "");
    Reconstruction ceiling = floor_and_ceiling();
    ceiling.patches.erase(ceiling.patches.begin());
    EXPECT_EQ(stage_figures(ceiling, {}), "");
}

}  // namespace
}  // namespace roomscribe
