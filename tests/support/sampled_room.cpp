// SPDX-License-Identifier: MIT
#include "support/sampled_room.hpp"

#include <cmath>

#include "roomscribe/core/random.hpp"

namespace roomscribe::test {
namespace {

class Sampler {
  public:
    Sampler(SampledRoom& room, double density, double noise, std::uint64_t seed)
        : room_(room), density_(density), noise_(noise), random_(seed) {}

    void rectangle(const Eigen::Vector3d& corner, const Eigen::Vector3d& u,
                   const Eigen::Vector3d& v, Label label) {
        const Eigen::Vector3d cross = u.cross(v);
        const auto count = static_cast<int>(cross.norm() * density_);
        for (int i = 0; i < count; ++i) {
            add(corner + random_.uniform() * u + random_.uniform() * v +
                    noise_ * random_.normal() * cross.normalized(),
                label);
        }
    }

    /// Four sides and the top.
    void box(const Eigen::Vector3d& corner, const Eigen::Vector3d& size) {
        const Eigen::Vector3d x = size.x() * Eigen::Vector3d::UnitX();
        const Eigen::Vector3d y = size.y() * Eigen::Vector3d::UnitY();
        const Eigen::Vector3d z = size.z() * Eigen::Vector3d::UnitZ();
        rectangle(corner + z, x, y, Label::unknown);
        rectangle(corner, x, z, Label::unknown);
        rectangle(corner + y, x, z, Label::unknown);
        rectangle(corner, y, z, Label::unknown);
        rectangle(corner + x, y, z, Label::unknown);
    }

    void ball(const Eigen::Vector3d& center, double radius) {
        const auto count = static_cast<int>(4.0 * 3.14159 * radius * radius * density_);
        for (int i = 0; i < count; ++i) {
            const Eigen::Vector3d direction(random_.normal(), random_.normal(), random_.normal());
            add(center + radius * direction.normalized(), Label::unknown);
        }
    }

    double uniform(double low, double high) { return random_.uniform(low, high); }

  private:
    void add(const Eigen::Vector3d& point, Label label) {
        room_.cloud.positions.push_back(point.cast<float>());
        room_.labels.push_back(label);
    }

    SampledRoom& room_;
    double density_;
    double noise_;
    Random random_;
};

}  // namespace

SampledRoom sample_room(double points_per_square_metre, double noise, std::uint64_t seed) {
    SampledRoom room;
    Sampler sampler(room, points_per_square_metre, noise, seed);
    const Eigen::Vector3d x = 5.0 * Eigen::Vector3d::UnitX();
    const Eigen::Vector3d y = 4.0 * Eigen::Vector3d::UnitY();
    const Eigen::Vector3d z = 2.7 * Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d origin = Eigen::Vector3d::Zero();
    sampler.rectangle(origin, x, y, Label::floor);
    sampler.rectangle(z, x, y, Label::ceiling);
    sampler.rectangle(origin, x, z, Label::wall);
    sampler.rectangle(y, x, z, Label::wall);
    sampler.rectangle(origin, y, z, Label::wall);
    sampler.rectangle(x, y, z, Label::wall);
    sampler.rectangle({2.0, 1.5, 0.74}, {1.6, 0, 0}, {0, 0.8, 0}, Label::unknown);
    sampler.box({0.3, 3.3, 0.0}, {1.2, 0.5, 1.8});
    for (int i = 0; i < 12; ++i) {
        const double radius = sampler.uniform(0.1, 0.2);
        sampler.ball({sampler.uniform(0.5, 4.5), sampler.uniform(0.5, 3.0), radius + 0.05}, radius);
    }
    for (int i = 0; i < 4; ++i) {
        sampler.ball({sampler.uniform(2.2, 3.4), sampler.uniform(1.7, 2.1), 0.86}, 0.08);
    }
    return room;
}

}  // namespace roomscribe::test
