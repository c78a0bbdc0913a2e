// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>

#include "roomscribe/model/scan.hpp"

namespace roomscribe {

/// Bytes that the arrays of a cloud take.
std::size_t memory_of(const PointCloud& cloud);

/// Bytes that a process needs at most to read these scans, reconstruct and write the result.
/// Settings that work on all points at once (interpretation.method=paper, plane methods other than
/// the default) may need more.
std::size_t memory_need(std::span<const Scan> scans);

}  // namespace roomscribe
