// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/furniture/chair_backs.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

namespace roomscribe {
namespace {

using Eigen::Vector3d;

/// Voxels of 4 cm that fill boxes, each a patch of its own.
class Patches {
  public:
    static constexpr double edge = 0.04;

    Patches() { all_.reach = 2.0 * edge; }

    void fill(const Vector3d& low, const Vector3d& high, bool is_level = false) {
        for (double x = low.x(); x <= high.x() + 1e-9; x += edge) {
            for (double y = low.y(); y <= high.y() + 1e-9; y += edge) {
                for (double z = low.z(); z <= high.z() + 1e-9; z += edge) {
                    FurnitureVoxel voxel;
                    voxel.place = {x, y, z};
                    voxel.height = z;
                    voxel.patch = num_patches_;
                    voxel.is_level = is_level;
                    voxel.is_upright = !is_level;
                    voxel.is_planar = true;
                    voxel.is_core = true;
                    all_.voxels.push_back(voxel);
                }
            }
        }
        ++num_patches_;
    }
    /// A back over its seat, which is 0.44 m deep, and four legs.
    void chair(double x) {
        fill({x, 0.0, 0.5}, {x + 0.4, 0.0, 0.86});
        fill({x, 0.04, 0.45}, {x + 0.4, 0.44, 0.45}, true);
        for (const double side : {0.0, 0.4}) {
            for (const double depth : {0.04, 0.44})
                fill({x + side, depth, 0.08}, {x + side, depth, 0.4});
        }
    }
    const FurnitureVoxels& voxels() const { return all_; }
    PieceDraft whole() const {
        PieceDraft draft;
        draft.voxels.resize(all_.voxels.size());
        std::iota(draft.voxels.begin(), draft.voxels.end(), 0U);
        return draft;
    }

  private:
    FurnitureVoxels all_;
    std::uint32_t num_patches_ = 0;
};

std::size_t num_chairs(const std::vector<PieceDraft>& drafts) {
    return static_cast<std::size_t>(std::count_if(
        drafts.begin(), drafts.end(), [](const PieceDraft& draft) { return draft.is_chair; }));
}

TEST(FindChairBacks, TellBacksFromFrontsScreensAndPartitions) {
    Patches made;
    made.fill({0.0, 0.0, 0.08}, {0.4, 0.0, 0.9});  // a front goes on down to the floor
    made.fill({2.0, 0.0, 1.0}, {2.4, 0.0, 1.3});   // a screen is higher
    made.fill({4.0, 0.0, 0.5}, {4.8, 0.0, 0.86});  // a partition is wider
    made.fill({6.0, 0.0, 0.5}, {6.4, 0.0, 0.86});
    const std::vector<ChairBack> backs = find_chair_backs(made.voxels());
    ASSERT_EQ(backs.size(), 1U);
    EXPECT_NEAR(backs[0].rectangle.center.x(), 6.2, 1e-6);
    EXPECT_NEAR(backs[0].bottom, 0.5, 0.03);
    EXPECT_NEAR(backs[0].top, 0.86, 0.03);
}

TEST(FindChairBacks, TakeTwoLayersOfNoiseForOne) {
    Patches made;
    made.fill({0.0, 0.0, 0.5}, {0.4, 0.0, 0.86});
    made.fill({0.08, 0.04, 0.5}, {0.44, 0.04, 0.86});
    EXPECT_EQ(find_chair_backs(made.voxels()).size(), 1U);
    FurnitureVoxels over_each_other = made.voxels();
    for (FurnitureVoxel& voxel : over_each_other.voxels)
        voxel.storey = voxel.patch;
    EXPECT_EQ(find_chair_backs(over_each_other).size(), 2U);
}

TEST(PartChairs, GivesEachBackWhatIsBeforeIt) {
    Patches made;
    made.chair(0.0);
    made.chair(0.48);
    std::vector<PieceDraft> drafts{made.whole()};
    part_chairs(made.voxels(), {}, drafts);
    ASSERT_EQ(num_chairs(drafts), 2U);
    EXPECT_TRUE(drafts[0].voxels.empty());
    EXPECT_EQ(drafts[1].voxels.size(), drafts[2].voxels.size());
}

TEST(PartChairs, LeavesASofaAndABoxWhole) {
    Patches sofa;  // deeper than chairs
    for (const double x : {0.0, 0.48})
        sofa.fill({x, 0.0, 0.5}, {x + 0.4, 0.0, 0.86});
    sofa.fill({0.0, 0.04, 0.45}, {0.88, 0.9, 0.45}, true);
    std::vector<PieceDraft> drafts{sofa.whole()};
    part_chairs(sofa.voxels(), {}, drafts);
    EXPECT_EQ(num_chairs(drafts), 0U);

    Patches box;  // closed below
    for (const double x : {0.0, 0.48}) {
        box.fill({x, 0.0, 0.5}, {x + 0.4, 0.0, 0.86});
        box.fill({x, 0.04, 0.08}, {x + 0.4, 0.04, 0.4});
    }
    drafts = {box.whole()};
    part_chairs(box.voxels(), {}, drafts);
    EXPECT_EQ(num_chairs(drafts), 0U);
}

TEST(PartChairs, DraftsABackThatNoDraftHasOverItsLegs) {
    Patches made;
    made.chair(0.0);
    made.fill({3.0, 0.0, 0.5}, {3.4, 0.0, 0.86});  // nothing below
    std::vector<PieceDraft> drafts;
    part_chairs(made.voxels(), {}, drafts);
    ASSERT_EQ(drafts.size(), 1U);
    EXPECT_EQ(drafts[0].voxels.size(), 11U * 10U);
    EXPECT_FALSE(drafts[0].is_chair);  // complete_chairs finds the rest
}

}  // namespace
}  // namespace roomscribe
