// SPDX-License-Identifier: MIT
#pragma once

#include "cli/explanation.hpp"
#include "roomscribe/model/scene.hpp"

namespace roomscribe::cli {

/// What a component is, where, how sure that is and why: all that scene.json tells of it.
Explanation explain_component(const Scene& scene, const Component& component);

/// How large a room is, and what bounds it, is in it and leads out of it.
Explanation explain_room(const Scene& scene, const Room& room);

/// One line for every room and component.
std::string scene_table(const Scene& scene);

}  // namespace roomscribe::cli
