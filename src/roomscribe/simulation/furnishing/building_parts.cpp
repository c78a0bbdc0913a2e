// SPDX-License-Identifier: MIT
#include "roomscribe/simulation/furnishing/item_kinds.hpp"

namespace roomscribe {
namespace {

using Eigen::Vector3d;

void add_block(ItemBuilder& builder, LabelSet also_right) {
    builder.begin(Label::unknown, builder.item().kind, also_right);
    builder.box(builder.part(Material::paint),
                {-builder.depth() / 2.0, -builder.width() / 2.0, 0.0},
                {builder.depth() / 2.0, builder.width() / 2.0, builder.height()});
}

}  // namespace

void build_column(ItemBuilder& builder) {
    add_block(builder, label_bit(Label::wall));
}

void build_round_column(ItemBuilder& builder) {
    builder.begin(Label::unknown, "column", label_bit(Label::wall));
    const double radius = std::min(builder.depth(), builder.width()) / 2.0;
    builder.cylinder(builder.part(Material::paint), {0.0, 0.0, 0.0}, {0.0, 0.0, builder.height()},
                     radius, 32);
}

void build_beam(ItemBuilder& builder) {
    add_block(builder, label_bit(Label::ceiling) | label_bit(Label::wall));
}

void build_soffit(ItemBuilder& builder) {
    // Two components: wall is right for its sides, but not for its underside.
    const double x = builder.depth() / 2.0;
    const double y = builder.width() / 2.0;
    const double h = builder.height();
    builder.begin(Label::unknown, builder.item().kind, label_bit(Label::ceiling));
    builder.quad(builder.part(Material::paint), {Vector3d(-x, -y, 0.0), Vector3d(-x, y, 0.0),
                                                 Vector3d(x, y, 0.0), Vector3d(x, -y, 0.0)});
    builder.begin(Label::unknown, "soffit_side",
                  label_bit(Label::ceiling) | label_bit(Label::wall));
    const std::uint32_t side = builder.part(Material::paint);
    builder.quad(
        side, {Vector3d(x, -y, 0.0), Vector3d(x, y, 0.0), Vector3d(x, y, h), Vector3d(x, -y, h)});
    builder.quad(side, {Vector3d(-x, y, 0.0), Vector3d(-x, -y, 0.0), Vector3d(-x, -y, h),
                        Vector3d(-x, y, h)});
    builder.quad(
        side, {Vector3d(x, y, 0.0), Vector3d(-x, y, 0.0), Vector3d(-x, y, h), Vector3d(x, y, h)});
    builder.quad(side, {Vector3d(-x, -y, 0.0), Vector3d(x, -y, 0.0), Vector3d(x, -y, h),
                        Vector3d(-x, -y, h)});
}

void build_pipe(ItemBuilder& builder) {
    builder.begin(Label::unknown, builder.item().kind);
    builder.cylinder(builder.part(Material::paint), {0.0, 0.0, 0.0}, {0.0, 0.0, builder.height()},
                     builder.width() / 2.0, 14);
}

}  // namespace roomscribe
