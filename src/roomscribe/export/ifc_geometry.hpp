// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "roomscribe/export/step_file.hpp"
#include "roomscribe/model/label.hpp"

namespace roomscribe {

/// Where something is, by its z and x axes, in the frame of what it is placed in.
struct IfcPlace {
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();
    Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
    Eigen::Vector3d x = Eigen::Vector3d::UnitX();
};

/// Placements, bodies and colours of an IFC file. Every function adds to the file and returns the
/// number of what it added.
class IfcGeometry {
  public:
    explicit IfcGeometry(StepFile& file);

    /// The geometric context of the project.
    const std::string& context() const { return context_; }

    /// IfcLocalPlacement relative to another ("$": the world).
    std::string placement(const std::string& relative_to, const IfcPlace& place = {});

    /// IfcExtrudedAreaSolid of a rectangle between two corners in the xy plane of `place`, or of a
    /// polygon, along its z by `depth` > 0; in the colour of a label.
    std::string box(const IfcPlace& place, const Eigen::Vector2d& low, const Eigen::Vector2d& high,
                    double depth, std::optional<Label> color = {});
    std::string prism(const IfcPlace& place, const std::vector<Eigen::Vector2d>& corners,
                      double depth, std::optional<Label> color = {});

    /// IfcProductDefinitionShape of bodies and, for walls, an axis from the origin along x.
    std::string shape(const std::vector<std::string>& bodies,
                      std::optional<double> axis_length = {});

  private:
    std::string point(const Eigen::VectorXd& coordinates);
    std::string direction(const Eigen::Vector3d& direction);
    std::string axes(const IfcPlace& place);
    std::string extrude(const std::string& profile, const IfcPlace& place, double depth,
                        std::optional<Label> color);
    void paint(const std::string& item, Label label);

    StepFile& file_;
    std::string context_;
    std::string body_context_;
    std::string axis_context_;
    std::map<Label, std::string> styles_;
};

}  // namespace roomscribe
