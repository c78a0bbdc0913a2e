// SPDX-License-Identifier: MIT
// Scans in, a described room out: the library in one screen.
#include <cstdio>
#include <exception>
#include <vector>

#include "roomscribe/io/point_cloud_io.hpp"
#include "roomscribe/pipeline/reconstruct.hpp"

using roomscribe::Component;
using roomscribe::Reconstruction;
using roomscribe::RegistrationLink;
using roomscribe::Scan;

int main(int argc, char** argv) {
    if (argc < 2) {
        std::puts("usage: describe_room SCAN...");
        return 2;
    }
    try {
        std::vector<Scan> scans;
        for (int i = 1; i < argc; ++i)
            scans.push_back(roomscribe::read_scan(argv[i]));
        const Reconstruction result = roomscribe::reconstruct(scans);

        for (const RegistrationLink& link : result.registration->links) {
            std::printf("scan %zu on scan %zu: %s, error %.1f mm\n", link.source, link.target,
                        link_verdict_name(link.verdict).data(), 1000.0 * link.rmse);
        }
        for (const Component& component : result.scene.components) {
            std::printf("%s, confidence %.2f, because: %s\n", component.id.c_str(),
                        component.confidence, component.evidence.rule.c_str());
        }
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 3;
    }
    return 0;
}
