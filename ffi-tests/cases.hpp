// Test cases for the comparison programs: the `data/convex` file format, and the triangulated hull that some peers need.
#pragma once

#include <array>
#include <string>
#include <vector>

enum class Kind { sphere, box, ellipsoid, cylinder, capsule, cone, hull };

struct Shape {
    Kind kind;
    std::vector<double> params;    // sphere r | box, ellipsoid: three half lengths | cylinder, capsule, cone: r half_height
    std::vector<double> vertices;  // hull only: x y z of every vertex
    std::array<double, 9> rotation;  // row-major, as in the file: never re-orthonormalised, the reference has used it too
    std::array<double, 3> translation;
};

struct Case {
    std::string id;
    Shape a, b;
    double size;  // the scale that errors and absolute tolerances are quoted against
};

// Throws std::runtime_error, with the file and the case, when the file is not what the format says.
std::vector<Case> load_cases(const std::string &path);

// The boundary of a convex hull, without the input points that are not on it. Peers get this where they ask for a mesh:
// a vertex that belongs to no face makes FCL fall back to a linear scan, and a hill climb could start from it in vain.
struct HullMesh {
    std::vector<double> vertices;              // x y z
    std::vector<std::array<int, 3>> triangles;  // counter-clockwise seen from outside
    std::vector<std::vector<int>> neighbours() const;
};

// Throws std::exception when the points are flat, or the triangulation is not a closed surface.
HullMesh hull_mesh(const std::vector<double> &points);
