// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/openings/window_parts.hpp"

#include <cmath>
#include <cstddef>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "roomscribe/core/random.hpp"

namespace roomscribe {
namespace {

using ::testing::Each;

constexpr double width = 1.2;
constexpr double height = 1.4;
constexpr double frame_width = 0.07;
/// Where the wall's relief, with cells of 8 cm, takes frame and pane to be.
constexpr WindowHole hole{width, height, 0.08, 0.0, 0.035};

/// Points of a window in its hole, and what they lie on.
class Window {
  public:
    explicit Window(double noise) : noise_(noise) {}

    /// A rectangle of points 1 cm apart.
    void add(WindowPart part, double left, double right, double low, double high, double depth) {
        for (double along = left + 0.005; along < right; along += 0.01) {
            for (double above = low + 0.005; above < high; above += 0.01)
                add_point(part, along, above, depth);
        }
    }
    void add_frame(double depth) {
        add(WindowPart::frame, 0.0, width, 0.0, frame_width, depth);
        add(WindowPart::frame, 0.0, width, height - frame_width, height, depth);
        add(WindowPart::frame, 0.0, frame_width, frame_width, height - frame_width, depth);
        add(WindowPart::frame, width - frame_width, width, frame_width, height - frame_width,
            depth);
    }
    /// Panes return few rays.
    void add_pane(std::size_t count, double depth) {
        for (std::size_t i = 0; i < count; ++i) {
            add_point(WindowPart::pane, random_.uniform(0.1, 0.55), random_.uniform(0.1, 1.3),
                      depth);
            add_point(WindowPart::pane, random_.uniform(0.65, 1.1), random_.uniform(0.1, 1.3),
                      depth);
        }
    }
    void add_point(WindowPart part, double along, double above, double depth) {
        points.push_back({static_cast<float>(along), static_cast<float>(above),
                          static_cast<float>(depth + noise_ * random_.normal())});
        parts.push_back(part);
    }

    /// Share of the points of a part that are taken for it.
    double share(WindowPart part) const {
        const std::vector<WindowPart> found = sort_window_points(points, hole, noise_);
        std::size_t num_points = 0;
        std::size_t num_right = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (parts[i] != part) continue;
            ++num_points;
            num_right += found[i] == part ? 1 : 0;
        }
        return static_cast<double>(num_right) / static_cast<double>(num_points);
    }

    std::vector<HolePoint> points;
    std::vector<WindowPart> parts;

  private:
    double noise_;
    Random random_{7};
};

class WindowOfNoise : public ::testing::TestWithParam<double> {};

TEST_P(WindowOfNoise, FrameMullionAndPaneAreToldWhereverTheyLie) {
    for (const double depth : {0.0, 0.08, 0.2}) {
        Window window(GetParam());
        window.add_frame(depth);
        window.add(WindowPart::frame, 0.58, 0.63, frame_width, height - frame_width, depth);
        window.add_pane(100, depth + 0.04);
        EXPECT_GT(window.share(WindowPart::frame), 0.98) << depth;
        EXPECT_GT(window.share(WindowPart::pane), 0.95) << depth;
    }
}
INSTANTIATE_TEST_SUITE_P(Scanners, WindowOfNoise, ::testing::Values(0.001, 0.004, 0.008));

TEST(SortWindowPoints, SidesOfAMullionAreFrameAtTheDepthOfThePane) {
    Window window(0.001);
    window.add_frame(0.08);
    window.add(WindowPart::frame, 0.58, 0.63, frame_width, height - frame_width, 0.08);
    window.add_pane(100, 0.12);
    for (double above = 0.2; above < 1.2; above += 0.01)
        window.add_point(WindowPart::frame, 0.625, above, 0.11);
    EXPECT_GT(window.share(WindowPart::frame), 0.99);
}

TEST(SortWindowPoints, ABlindIsWhatTheWindowShows) {
    Window window(0.002);
    window.add_frame(0.1);
    window.add(WindowPart::pane, 0.01, width - 0.01, 0.6, height, 0.06);
    window.add_pane(50, 0.14);
    EXPECT_GT(window.share(WindowPart::pane), 0.95);
    EXPECT_GT(window.share(WindowPart::frame), 0.95);
}

TEST(SortWindowPoints, BeforeTheFrameLiesTheReveal) {
    Window window(0.002);
    window.add_frame(0.15);
    for (double above = 0.0; above < height; above += 0.01) {
        for (double depth = 0.01; depth < 0.12; depth += 0.01)
            window.add_point(WindowPart::reveal, 0.0, above, depth);
        window.add_point(WindowPart::reveal, -0.02, above, 0.0);
    }
    EXPECT_DOUBLE_EQ(window.share(WindowPart::reveal), 1.0);
    EXPECT_GT(window.share(WindowPart::frame), 0.99);
}

TEST(SortWindowPoints, FewPointsAreSortedByWhatTheWallTold) {
    const std::vector<HolePoint> frame{{0.04F, 0.5F, 0.0F}, {0.6F, 1.37F, 0.001F}};
    EXPECT_THAT(sort_window_points(frame, hole, 0.002), Each(WindowPart::frame));
    const std::vector<HolePoint> pane{{0.4F, 0.5F, 0.035F}, {0.6F, 0.9F, 0.036F}};
    EXPECT_THAT(sort_window_points(pane, hole, 0.002), Each(WindowPart::pane));
    EXPECT_TRUE(sort_window_points({}, hole, 0.002).empty());
}

}  // namespace
}  // namespace roomscribe
