// SPDX-License-Identifier: MIT
#include "roomscribe/interpretation/upright/length_unit_estimate.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "support/shapes.hpp"
#include "support/simulated_rooms.hpp"

namespace roomscribe {
namespace {

Scan room_in(LengthUnit unit) {
    static const Scan room = test::scan_furnished_room(3).front();
    Scan scan = room;
    scale_in_place(scan.cloud, 1.0 / metres_per(unit));
    return scan;
}

TEST(EstimateLengthUnit, IsToldByTheHeightOfTheRoom) {
    for (const LengthUnit unit :
         {LengthUnit::millimetre, LengthUnit::centimetre, LengthUnit::inch}) {
        SCOPED_TRACE(length_unit_word(unit));
        const LengthUnitEstimate found = estimate_length_unit(room_in(unit));
        EXPECT_EQ(found.stop, LengthUnitStop::told);
        EXPECT_EQ(found.unit, unit);
        ASSERT_TRUE(found.room_height);
        EXPECT_NEAR(*found.room_height, 2.7, 0.05);
        EXPECT_NE(found.reason.find(length_unit_word(unit)), std::string::npos);
    }
}

TEST(EstimateLengthUnit, MetresAndWhatIsNoRoomAreLeftAlone) {
    EXPECT_EQ(estimate_length_unit(room_in(LengthUnit::metre)).stop, LengthUnitStop::metres);
    EXPECT_EQ(estimate_length_unit(room_in(LengthUnit::foot)).stop, LengthUnitStop::metres);
    EXPECT_EQ(estimate_length_unit({}).stop, LengthUnitStop::metres);
    Random random(2);
    Scan cloud;
    cloud.cloud.positions = test::random_points(random, 20000, 60.0);
    EXPECT_EQ(estimate_length_unit(cloud).stop, LengthUnitStop::metres);
    cloud.cloud.positions = test::random_points(random, 20000, 1000.0);
    EXPECT_EQ(estimate_length_unit(cloud).stop, LengthUnitStop::untold);
}

TEST(MayBeFeet, WhereRoomsAreAsHighAsInFeet) {
    Room room;
    room.ceiling_height = 8.9;
    EXPECT_TRUE(may_be_feet({&room, 1}, {}));
    const std::vector<double> tripod{4.9};
    EXPECT_TRUE(may_be_feet({&room, 1}, tripod));
    const std::vector<double> floor{0.3};
    EXPECT_FALSE(may_be_feet({&room, 1}, floor));
    room.ceiling_height = 2.7;
    EXPECT_FALSE(may_be_feet({&room, 1}, {}));
    EXPECT_FALSE(may_be_feet({}, {}));
}

}  // namespace
}  // namespace roomscribe
