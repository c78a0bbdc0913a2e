// SPDX-License-Identifier: MIT
#include "roomscribe/model/registration_result.hpp"

namespace roomscribe {

std::string_view link_verdict_name(LinkVerdict verdict) {
    switch (verdict) {
        case LinkVerdict::accepted:
            return "accepted";
        case LinkVerdict::ambiguous:
            return "ambiguous";
        case LinkVerdict::rejected:
            return "rejected";
    }
    return "";
}

std::string_view loop_check_name(LoopCheck check) {
    switch (check) {
        case LoopCheck::none:
            return "none";
        case LoopCheck::agrees:
            return "agrees";
        case LoopCheck::disagrees:
            return "disagrees";
        case LoopCheck::resolved:
            return "resolved";
    }
    return "";
}

}  // namespace roomscribe
