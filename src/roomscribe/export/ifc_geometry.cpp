// SPDX-License-Identifier: MIT
#include "roomscribe/export/ifc_geometry.hpp"

#include <fmt/format.h>

namespace roomscribe {
namespace {

/// Glass is seen through; ceilings too, or a model shows but its lid.
double transparency(Label label) {
    return label == Label::window ? 0.6 : label == Label::ceiling ? 0.7 : 0.0;
}

}  // namespace

IfcGeometry::IfcGeometry(StepFile& file) : file_(file) {
    context_ = file_.add("IFCGEOMETRICREPRESENTATIONCONTEXT",
                         {"$", "'Model'", "3", "1.E-05", axes({}), "$"});
    const auto subcontext = [&](const char* name, const char* view) {
        return file_.add("IFCGEOMETRICREPRESENTATIONSUBCONTEXT",
                         {name, "'Model'", "*", "*", "*", "*", context_, "$", view, "$"});
    };
    body_context_ = subcontext("'Body'", ".MODEL_VIEW.");
    axis_context_ = subcontext("'Axis'", ".GRAPH_VIEW.");
}

std::string IfcGeometry::point(const Eigen::VectorXd& coordinates) {
    return file_.add("IFCCARTESIANPOINT", {step_numbers(coordinates)});
}

std::string IfcGeometry::direction(const Eigen::Vector3d& direction) {
    return file_.add("IFCDIRECTION", {step_numbers(direction)});
}

std::string IfcGeometry::axes(const IfcPlace& place) {
    const std::string origin = point(place.origin);
    const std::string z = direction(place.z);
    const std::string x = direction(place.x);
    return file_.add("IFCAXIS2PLACEMENT3D", {origin, z, x});
}

std::string IfcGeometry::placement(const std::string& relative_to, const IfcPlace& place) {
    const std::string at = axes(place);
    return file_.add("IFCLOCALPLACEMENT", {relative_to, at});
}

std::string IfcGeometry::box(const IfcPlace& place, const Eigen::Vector2d& low,
                             const Eigen::Vector2d& high, double depth,
                             std::optional<Label> color) {
    const std::string middle = point(0.5 * (low + high));
    const std::string center = file_.add("IFCAXIS2PLACEMENT2D", {middle, "$"});
    const std::string profile = file_.add(
        "IFCRECTANGLEPROFILEDEF",
        {".AREA.", "$", center, step_real(high.x() - low.x()), step_real(high.y() - low.y())});
    return extrude(profile, place, depth, color);
}

std::string IfcGeometry::prism(const IfcPlace& place, const std::vector<Eigen::Vector2d>& corners,
                               double depth, std::optional<Label> color) {
    std::vector<std::string> points;
    points.reserve(corners.size() + 1);
    for (const Eigen::Vector2d& corner : corners)
        points.push_back(point(corner));
    points.push_back(points.front());
    const std::string outline = file_.add("IFCPOLYLINE", {step_list(points)});
    const std::string profile = file_.add("IFCARBITRARYCLOSEDPROFILEDEF", {".AREA.", "$", outline});
    return extrude(profile, place, depth, color);
}

std::string IfcGeometry::extrude(const std::string& profile, const IfcPlace& place, double depth,
                                 std::optional<Label> color) {
    const std::string at = axes(place);
    const std::string up = direction(Eigen::Vector3d::UnitZ());
    std::string solid = file_.add("IFCEXTRUDEDAREASOLID", {profile, at, up, step_real(depth)});
    if (color) paint(solid, *color);
    return solid;
}

void IfcGeometry::paint(const std::string& item, Label label) {
    auto found = styles_.find(label);
    if (found == styles_.end()) {
        const auto rgb = label_color(label);
        const auto share = [&](std::size_t i) { return step_real(rgb[i] / 255.0); };
        const std::string color = file_.add("IFCCOLOURRGB", {"$", share(0), share(1), share(2)});
        const std::string shading =
            file_.add("IFCSURFACESTYLESHADING", {color, step_real(transparency(label))});
        const std::string style = file_.add(
            "IFCSURFACESTYLE", {step_text(label_name(label)), ".BOTH.", "(" + shading + ")"});
        found = styles_.emplace(label, style).first;
    }
    file_.add("IFCSTYLEDITEM", {item, "(" + found->second + ")", "$"});
}

std::string IfcGeometry::shape(const std::vector<std::string>& bodies,
                               std::optional<double> axis_length) {
    std::vector<std::string> representations;
    if (axis_length) {
        const std::string from = point(Eigen::Vector2d(0.0, 0.0));
        const std::string to = point(Eigen::Vector2d(*axis_length, 0.0));
        const std::string line = file_.add("IFCPOLYLINE", {fmt::format("({},{})", from, to)});
        representations.push_back(file_.add(
            "IFCSHAPEREPRESENTATION", {axis_context_, "'Axis'", "'Curve2D'", "(" + line + ")"}));
    }
    representations.push_back(file_.add(
        "IFCSHAPEREPRESENTATION", {body_context_, "'Body'", "'SweptSolid'", step_list(bodies)}));
    return file_.add("IFCPRODUCTDEFINITIONSHAPE", {"$", "$", step_list(representations)});
}

}  // namespace roomscribe
