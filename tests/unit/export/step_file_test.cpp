// SPDX-License-Identifier: MIT
#include "roomscribe/export/step_file.hpp"

#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace roomscribe {
namespace {

TEST(StepText, EscapesWhatStepDoesNotAllow) {
    EXPECT_EQ(step_text("wall-3"), "'wall-3'");
    EXPECT_EQ(step_text("it's a \\"), "'it''s a \\\\'");
    EXPECT_EQ(step_text("m\u00b2"), "'m\\X2\\00B2\\X0\\'");
    EXPECT_EQ(step_text("\U0001F6AA"), "'\\X4\\0001F6AA\\X0\\'");
    EXPECT_EQ(step_text("\xff"), "'?'");
    EXPECT_EQ(step_text("\xc2"), "'?'");
}

TEST(StepReal, AlwaysHasAPoint) {
    EXPECT_EQ(step_real(3), "3.");
    EXPECT_EQ(step_real(-0.0), "0.");
    EXPECT_EQ(step_real(1.25), "1.25");
    EXPECT_EQ(step_real(-1e-12), "0.");
    EXPECT_EQ(step_real(1e-6), "0.000001");
    EXPECT_EQ(step_numbers(Eigen::Vector3d(1, 0.5, -2)), "(1.,0.5,-2.)");
}

TEST(StepFile, NumbersItsEntities) {
    StepFile file;
    EXPECT_EQ(file.add("IFCDIRECTION", {"(0.,0.,1.)"}), "#1");
    EXPECT_EQ(file.add("IFCX", {"$", "#1"}), "#2");
    EXPECT_EQ(file.text("FILE_SCHEMA(('IFC4'));\n"),
              "ISO-10303-21;\nHEADER;\nFILE_SCHEMA(('IFC4'));\nENDSEC;\nDATA;\n"
              "#1=IFCDIRECTION((0.,0.,1.));\n#2=IFCX($,#1);\nENDSEC;\nEND-ISO-10303-21;\n");
}

TEST(IfcGlobalId, HasItsFormAndFollowsFromTheText) {
    std::set<std::string> ids;
    for (int i = 0; i < 2000; ++i) {
        const std::string id = ifc_global_id("wall-" + std::to_string(i));
        EXPECT_EQ(id.size(), 22U);
        EXPECT_THAT(id[0], testing::AnyOf('0', '1', '2', '3'));
        EXPECT_EQ(id.find_first_not_of("0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                       "abcdefghijklmnopqrstuvwxyz_$"),
                  std::string::npos);
        ids.insert(id);
    }
    EXPECT_EQ(ids.size(), 2000U);
    EXPECT_EQ(ifc_global_id("wall-3"), ifc_global_id("wall-3"));
}

}  // namespace
}  // namespace roomscribe
