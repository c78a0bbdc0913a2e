// SPDX-License-Identifier: MIT
#include "roomscribe/model/kept_result.hpp"

#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "roomscribe/model/result_bytes.hpp"

namespace roomscribe {
namespace {

/// Keeps results in memory.
class MemoryStore final : public ResultStore {
  public:
    void keep(std::string_view name, const std::function<void(const Write&)>& give) override {
        std::vector<std::byte>& bytes = kept[std::string(name)];
        bytes.clear();
        give([&](std::span<const std::byte> more) {
            bytes.insert(bytes.end(), more.begin(), more.end());
        });
    }
    bool recall(std::string_view name,
                const std::function<void(std::span<const std::byte>)>& take) override {
        const auto found = kept.find(std::string(name));
        if (found == kept.end()) return false;
        take(found->second);
        return true;
    }

    std::map<std::string, std::vector<std::byte>> kept;
};

RegistrationLink some_link() {
    RegistrationLink link;
    link.source = 7;
    link.target = 3;
    link.target_from_source = Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized()) *
                              Eigen::Translation3d(0.1, 1.0 / 3.0, -2.0);
    link.verdict = LinkVerdict::ambiguous;
    link.loops = LoopCheck::resolved;
    link.probability = 0.75;
    link.inliers = 12345;
    link.covariance = Eigen::Matrix<double, 6, 6>::Random();
    link.unobservable = {Eigen::Matrix<double, 6, 1>::Random()};
    link.rivals = {Transform::Identity(), link.target_from_source.inverse()};
    link.stop_reason = "converged";
    return link;
}

Scene some_scene() {
    Scene scene;
    scene.room_from_map = some_link().target_from_source;
    Component wall;
    wall.id = "wall-3";
    wall.label = Label::wall;
    wall.polygon = {Eigen::Vector3d::Random(), Eigen::Vector3d::Random()};
    wall.evidence.rule = "a wall is where a room ends";
    wall.evidence.coverage = 0.5;
    Component handle;
    handle.id = "handle-1";
    handle.box.emplace().size = {0.1, 0.2, 0.3};
    handle.grasp.emplace().opening = 0.01;
    handle.opens.emplace().kind = MotionKind::pull;
    scene.components = {wall, handle};
    scene.rooms = {{.id = "room-1",
                    .polygon = wall.polygon,
                    .walls = {"wall-3"},
                    .neighbors = {{"room-2", "door-1"}}}};
    return scene;
}

template <typename Value>
std::vector<std::byte> bytes_of(const Value& value) {
    MemoryStore store;
    Context context;
    context.results = &store;
    keep(context, "value", value);
    return store.kept.at("value");
}

/// What comes back has the same bytes: every field that is kept is recalled.
template <typename Value>
void expect_round_trip(const Value& value) {
    MemoryStore store;
    Context context;
    context.results = &store;
    keep(context, "value", value);
    Value back;
    ASSERT_TRUE(recall(context, "value", back));
    EXPECT_EQ(bytes_of(back), bytes_of(value));
    EXPECT_NE(bytes_of(Value{}), bytes_of(value));
}

TEST(KeptResult, ComesBackAsItWas) {
    expect_round_trip(some_link());
    expect_round_trip(some_scene());
    Registration registration;
    registration.map_from_scan = {Transform::Identity(), std::nullopt};
    registration.is_doubtful = {true, false, true};
    registration.links = {some_link()};
    registration.components = {{0, 2}, {1}};
    registration.residuals = {0.1, 0.2};
    expect_round_trip(registration);
    expect_round_trip(PointLabels{{Label::wall, Label::door}, {3, -1}, {0.5F, 1.0F}});
    expect_round_trip(std::vector<DerivedValue>{{"name", 1.0 / 3.0, "m", "a reason"}});

    const RegistrationLink link = some_link();
    MemoryStore store;
    Context context;
    context.results = &store;
    keep(context, "link", link);
    RegistrationLink back;
    ASSERT_TRUE(recall(context, "link", back));
    EXPECT_EQ(back.source, link.source);
    EXPECT_EQ(back.target_from_source.matrix(), link.target_from_source.matrix());
    EXPECT_EQ(back.rivals.at(1).matrix(), link.rivals.at(1).matrix());
    EXPECT_EQ(back.stop_reason, "converged");
}

TEST(KeptResult, IsRefusedWhereBytesAreMissingOrLeft) {
    MemoryStore store;
    Context context;
    context.results = &store;
    const std::vector<std::byte> whole = bytes_of(some_scene());
    Scene scene;
    for (std::size_t size = 0; size < whole.size(); ++size) {
        store.kept["scene"].assign(whole.begin(), whole.begin() + static_cast<long>(size));
        ASSERT_THROW(recall(context, "scene", scene), Error) << size;
    }
    store.kept["scene"] = whole;
    store.kept["scene"].push_back(std::byte{0});
    EXPECT_THROW(recall(context, "scene", scene), Error);
    // A count that the bytes cannot back makes nobody allocate.
    store.kept["scene"].assign(8, std::byte{0xFF});
    std::vector<double> numbers;
    EXPECT_THROW(recall(context, "scene", numbers), Error);
}

TEST(KeptResult, IsComputedOnce) {
    MemoryStore store;
    Context context;
    context.results = &store;
    int num_calls = 0;
    const auto compute = [&] {
        ++num_calls;
        return some_link();
    };
    EXPECT_EQ(kept(context, "pair-7-3", compute).inliers, 12345U);
    EXPECT_EQ(kept(context, "pair-7-3", compute).inliers, 12345U);
    EXPECT_EQ(num_calls, 1);
    EXPECT_EQ(kept({}, "pair-7-3", compute).inliers, 12345U);
    EXPECT_EQ(num_calls, 2);
}

}  // namespace
}  // namespace roomscribe
