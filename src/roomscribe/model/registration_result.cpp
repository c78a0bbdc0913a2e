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

}  // namespace roomscribe
