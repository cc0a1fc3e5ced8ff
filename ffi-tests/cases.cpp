#include "cases.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <map>
#include <set>
#include <stdexcept>

#include <libqhullcpp/Qhull.h>
#include <libqhullcpp/QhullFacetList.h>
#include <libqhullcpp/QhullVertexSet.h>

namespace {

// A token reader. `stream >> double` is not enough: it refuses "nan", which the format uses.
class Tokens {
public:
    explicit Tokens(const std::string &path) : path_(path), in_(path) {
        if (!in_) fail("cannot be opened");
    }

    bool next(std::string &token) { return static_cast<bool>(in_ >> token); }

    std::string word() {
        std::string token;
        if (!next(token)) fail("ends early");
        return token;
    }

    void expect(const char *what) {
        const std::string token = word();
        if (token != what) fail("expected '" + std::string(what) + "', found '" + token + "'");
    }

    double number() {
        const std::string token = word();
        char *end = nullptr;
        const double value = std::strtod(token.c_str(), &end);
        if (end == token.c_str() || *end != '\0') fail("not a number: '" + token + "'");
        return value;
    }

    std::vector<double> numbers(std::size_t count) {
        std::vector<double> values(count);
        for (double &value : values) value = number();
        return values;
    }

    std::size_t count(std::size_t limit) {
        const double value = number();
        if (!(value >= 0 && value <= static_cast<double>(limit))) fail("a count is out of range");
        return static_cast<std::size_t>(value);
    }

    [[noreturn]] void fail(const std::string &message) const {
        throw std::runtime_error(path_ + (case_.empty() ? "" : ", case " + case_) + ": " + message);
    }

    void in_case(const std::string &id) { case_ = id; }

private:
    std::string path_, case_;
    std::ifstream in_;
};

struct KindName {
    const char *name;
    Kind kind;
    std::size_t params;
};

constexpr KindName KINDS[] = {
    {"sphere", Kind::sphere, 1},   {"box", Kind::box, 3},         {"ellipsoid", Kind::ellipsoid, 3},
    {"cylinder", Kind::cylinder, 2}, {"capsule", Kind::capsule, 2}, {"cone", Kind::cone, 2},
};

Shape read_shape(Tokens &tokens) {
    Shape shape{};
    tokens.expect("S");
    const std::string type = tokens.word();
    if (type == "hull") {
        shape.kind = Kind::hull;
        shape.vertices = tokens.numbers(3 * tokens.count(1000000));
    } else {
        const auto *found = std::find_if(std::begin(KINDS), std::end(KINDS),
                                         [&](const KindName &candidate) { return type == candidate.name; });
        if (found == std::end(KINDS)) tokens.fail("unknown shape '" + type + "'");
        shape.kind = found->kind;
        if (tokens.count(16) != found->params) tokens.fail("wrong number of parameters for " + type);
        shape.params = tokens.numbers(found->params);
    }
    tokens.expect("P");
    for (double &value : shape.rotation) value = tokens.number();
    for (double &value : shape.translation) value = tokens.number();
    return shape;
}

}  // namespace

std::vector<Case> load_cases(const std::string &path) {
    Tokens tokens(path);
    std::vector<Case> cases;
    for (std::string token; tokens.next(token);) {
        if (token != "CASE") tokens.fail("expected 'CASE', found '" + token + "'");
        Case c;
        c.id = tokens.word();
        tokens.in_case(c.id);
        c.a = read_shape(tokens);
        c.b = read_shape(tokens);
        tokens.expect("T");
        // Only the size is used here: the solvers must not see the reference. compare_table.py reads the rest.
        c.size = tokens.numbers(7)[3];
        cases.push_back(std::move(c));
    }
    return cases;
}

HullMesh hull_mesh(const std::vector<double> &points) {
    // Qt: facets that qhull has merged because they are coplanar (the sides of a cube) come back as triangles, all of
    // them over the same vertices, so that every facet below has exactly three.
    const orgQhull::Qhull qhull("", 3, static_cast<int>(points.size() / 3), points.data(), "Qt");

    HullMesh mesh;
    std::map<int, int> index_of;  // input point -> vertex of the mesh
    for (const orgQhull::QhullFacet &facet : qhull.facetList()) {
        std::array<int, 3> triangle{};
        std::size_t corner = 0;
        for (const orgQhull::QhullVertex &vertex : facet.vertices()) {
            if (corner == 3) throw std::runtime_error("hull facet with more than three vertices");
            const int id = vertex.point().id();
            const auto [entry, is_new] = index_of.try_emplace(id, static_cast<int>(index_of.size()));
            if (is_new) mesh.vertices.insert(mesh.vertices.end(), &points[3 * id], &points[3 * id] + 3);
            triangle[corner++] = entry->second;
        }
        if (corner != 3) throw std::runtime_error("hull facet with fewer than three vertices");
        // Qhull's own orientation flag, not the sign of a computed normal: triangles of a merged facet may be slivers.
        if (facet.isTopOrient()) std::swap(triangle[0], triangle[1]);
        mesh.triangles.push_back(triangle);
    }

    // Every directed edge once, and its reverse once: closed and consistently oriented. A hill climb needs that.
    std::set<std::pair<int, int>> edges;
    for (const auto &t : mesh.triangles)
        for (int i = 0; i < 3; ++i)
            if (!edges.emplace(t[i], t[(i + 1) % 3]).second) throw std::runtime_error("hull edge used twice");
    for (const auto &[from, to] : edges)
        if (edges.count({to, from}) == 0) throw std::runtime_error("hull is not closed");
    return mesh;
}

std::vector<std::vector<int>> HullMesh::neighbours() const {
    std::vector<std::vector<int>> result(vertices.size() / 3);
    for (const auto &t : triangles)  // each undirected edge is seen once in each direction
        for (int i = 0; i < 3; ++i) result[t[i]].push_back(t[(i + 1) % 3]);
    return result;
}
