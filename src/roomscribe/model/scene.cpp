// SPDX-License-Identifier: MIT
#include "roomscribe/model/scene.hpp"

namespace roomscribe {

std::string_view verdict_name(Verdict verdict) {
    switch (verdict) {
        case Verdict::accepted:
            return "accepted";
        case Verdict::doubtful:
            return "doubtful";
        case Verdict::rejected:
            return "rejected";
    }
    return "";
}

}  // namespace roomscribe
