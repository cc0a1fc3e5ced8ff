// The truth that errors are measured against: depth of two bodies in quadruple precision, as a bracket, with none of the library's code.
//
//     oracle CASES [float] [SHARE [STEPS]]      one line a case: case,lower,upper,nx,ny,nz
//
// `float`: the numbers of the file are rounded to single precision first. SHARE: the width of the bracket that is enough, relative to the depth (1e-15); STEPS: after so many
// it is left as wide as it is (4000).
//
// With h(u) the support function of A - B, d = min h(u) over unit vectors u: positive, how deep the bodies overlap, negative, minus their distance. Any u proves d <= h(u).
// A polytope P inside of A - B proves d >= the least offset of its facets where the origin is in P, and d >= -|x| for any point x of it. P grows by the point that is
// farthest along the lowest facet's normal, as in any textbook; all in numbers of 34 digits, so that rounding never matters (a unit of it is 1e-34 of the bodies' size),
// with formulas of support functions that are written down once more. Bodies are the images of shapes under the matrix as it is given, but balls (spheres, the ends
// of capsules) stay balls: they are added to h in the end.

#include <quadmath.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <map>
#include <vector>

#include "../../../ffi-tests/cases.hpp"

namespace {

using Real = __float128;

struct Vec {
    Real x[3] = {0, 0, 0};
    Real &operator[](int i) { return x[i]; }
    const Real &operator[](int i) const { return x[i]; }
};
Vec operator+(const Vec &a, const Vec &b) { return {{a[0] + b[0], a[1] + b[1], a[2] + b[2]}}; }
Vec operator-(const Vec &a, const Vec &b) { return {{a[0] - b[0], a[1] - b[1], a[2] - b[2]}}; }
Vec operator*(const Vec &a, Real s) { return {{a[0] * s, a[1] * s, a[2] * s}}; }
Real dot(const Vec &a, const Vec &b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vec cross(const Vec &a, const Vec &b) {
    return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}
Real norm(const Vec &a) { return sqrtq(dot(a, a)); }
Vec unit(const Vec &a) {
    const Real largest = std::max({fabsq(a[0]), fabsq(a[1]), fabsq(a[2])});
    const Vec b = a * (1 / largest);
    return b * (1 / norm(b));
}

// ------------------------------------------------------------------------------------------------------------- bodies

struct Body {
    Kind kind;
    std::vector<Real> p;
    std::vector<Vec> points;
    Real rotation[9];
    Vec translation;
    Real ball = 0;

    Body(const Shape &shape, bool single) : kind(shape.kind) {
        const auto number = [single](double x) { return static_cast<Real>(single ? static_cast<double>(static_cast<float>(x)) : x); };
        for (const double x : shape.params) p.push_back(number(x));
        for (std::size_t i = 0; i + 2 < shape.vertices.size(); i += 3)
            points.push_back({{number(shape.vertices[i]), number(shape.vertices[i + 1]), number(shape.vertices[i + 2])}});
        for (int i = 0; i < 9; ++i) rotation[i] = number(shape.rotation[i]);
        for (int i = 0; i < 3; ++i) translation[i] = number(shape.translation[i]);
        if (kind == Kind::sphere || kind == Kind::capsule) ball = p[0];
    }

    // The farthest point of the core, which is the body without its ball.
    Vec farthest(const Vec &u) const {
        Vec w, y = translation;
        for (int j = 0; j < 3; ++j)
            for (int i = 0; i < 3; ++i) w[j] += rotation[3 * i + j] * u[i];
        const Vec x = own(w);
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) y[i] += rotation[3 * i + j] * x[j];
        return y;
    }

private:
    Vec own(const Vec &w) const {
        const auto sign = [](Real x) -> Real { return x < 0 ? -1 : 1; };
        const auto rim = [&](Real z) -> Vec {
            const Real across = sqrtq(w[0] * w[0] + w[1] * w[1]);
            return across > 0 ? Vec{{p[0] * w[0] / across, p[0] * w[1] / across, z}} : Vec{{0, 0, z}};
        };
        switch (kind) {
            case Kind::sphere: return {};
            case Kind::capsule: return {{0, 0, sign(w[2]) * p[1]}};
            case Kind::box: return {{sign(w[0]) * p[0], sign(w[1]) * p[1], sign(w[2]) * p[2]}};
            case Kind::cylinder: return rim(sign(w[2]) * p[1]);
            case Kind::cone: {
                const Vec apex{{0, 0, p[1]}}, low = rim(-p[1]);
                return dot(apex, w) > dot(low, w) ? apex : low;
            }
            case Kind::ellipsoid: {
                const Vec e{{p[0] * w[0], p[1] * w[1], p[2] * w[2]}};
                const Real length = norm(e);
                return length > 0 ? Vec{{p[0] * e[0] / length, p[1] * e[1] / length, p[2] * e[2] / length}} : Vec{};
            }
            case Kind::hull: break;
        }
        return *std::max_element(points.begin(), points.end(), [&](const Vec &a, const Vec &b) { return dot(a, w) < dot(b, w); });
    }
};

// The core of A - B.
struct Difference {
    Body a, b;
    Real ball;

    Difference(const Case &c, bool single) : a(c.a, single), b(c.b, single), ball(a.ball + b.ball) {}
    Vec farthest(const Vec &u) const { return a.farthest(u) - b.farthest(u * -1); }
};

// ---------------------------------------------------------------------------------------------------------- polytopes

struct Facet {
    int v[3];
    Vec normal;
    Real offset;
    bool done = false;  // nothing is farther out
};

class Polytope {
public:
    std::vector<Vec> points;
    std::vector<Facet> facets;

    // False where the four points lie in a plane.
    bool start(const Vec (&corners)[4], Real small) {
        points.assign(corners, corners + 4);
        const int faces[4][3] = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
        const Real volume = dot(cross(points[1] - points[0], points[2] - points[0]), points[3] - points[0]);
        if (fabsq(volume) <= small) return false;
        for (const auto &f : faces) {
            if (volume > 0)
                add(f[0], f[2], f[1]);
            else
                add(f[0], f[1], f[2]);
        }
        return true;
    }

    Facet *lowest() {
        Facet *low = nullptr;
        for (Facet &f : facets)
            if (!f.done && (low == nullptr || f.offset < low->offset)) low = &f;
        return low;
    }

    Real least() const {
        Real least = HUGE_VALQ;
        for (const Facet &f : facets) least = std::min(least, f.offset);
        return least;
    }

    // Puts a point on that is outside of the facet `seen`.
    bool insert(const Vec &p, Facet *seen, Real blur) {
        const int index = static_cast<int>(points.size());
        std::map<std::pair<int, int>, int> edges;
        std::vector<Facet> kept;
        for (Facet &f : facets) {
            if (&f != seen && dot(f.normal, p) - f.offset <= blur) {
                kept.push_back(f);
                continue;
            }
            for (int i = 0; i < 3; ++i) ++edges[{f.v[i], f.v[(i + 1) % 3]}];
        }
        points.push_back(p);
        facets.swap(kept);
        for (const auto &edge : edges)
            if (edges.find({edge.first.second, edge.first.first}) == edges.end() && !add(edge.first.first, edge.first.second, index)) {
                return false;
            }
        return true;
    }

private:
    bool add(int a, int b, int c) {
        const Vec n = cross(points[b] - points[a], points[c] - points[a]);
        const Real length = norm(n);
        if (!(length > 0)) return false;
        Facet f{{a, b, c}, n * (1 / length), 0};
        f.offset = dot(f.normal, points[a]);
        facets.push_back(f);
        return true;
    }
};

struct Found {
    Real lower, upper;
    Vec normal;
    void take(const Vec &u, Real height) {
        if (height < upper) {
            upper = height;
            normal = u;
        }
    }
};

// The point of the hull of at most four points that is nearest to the origin: that of all triangles, edges and corners. (The origin is not inside.)
Vec nearest(const std::vector<Vec> &simplex, std::vector<Vec> &kept) {
    Vec best;
    Real least = HUGE_VALQ;
    const int n = static_cast<int>(simplex.size());
    for (int mask = 1; mask < 1 << n; ++mask) {
        std::vector<Vec> s;
        for (int i = 0; i < n; ++i)
            if (mask >> i & 1) s.push_back(simplex[i]);
        Vec x;
        if (s.size() == 1) {
            x = s[0];
        } else if (s.size() == 2) {
            const Vec e = s[1] - s[0];
            const Real t = -dot(s[0], e) / dot(e, e);
            if (!(t >= 0 && t <= 1)) continue;
            x = s[0] + e * t;
        } else if (s.size() == 3) {
            const Vec e = s[1] - s[0], f = s[2] - s[0];
            const Real ee = dot(e, e), ef = dot(e, f), ff = dot(f, f), det = ee * ff - ef * ef;
            const Real a = (-dot(s[0], e) * ff + dot(s[0], f) * ef) / det, b = (-dot(s[0], f) * ee + dot(s[0], e) * ef) / det;
            if (!(a >= 0 && b >= 0 && a + b <= 1)) continue;
            x = s[0] + e * a + f * b;
        } else {
            continue;
        }
        const Real squared = dot(x, x);
        if (squared < least) {
            least = squared;
            best = x;
            kept = s;
        }
    }
    return best;
}

// The distance of the core from the origin, as a bracket of minus it.
Found apart(const Difference &set, const Vec &first, Real share) {
    std::vector<Vec> simplex{set.farthest(first)};
    Found found{-HUGE_VALQ, HUGE_VALQ, {}};
    for (int i = 0; i < 10000; ++i) {
        std::vector<Vec> kept;
        const Vec x = nearest(simplex, kept);
        const Real length = norm(x);
        found.lower = std::max(found.lower, -length);
        if (!(length > 0)) break;
        const Vec u = unit(x * -1), p = set.farthest(u);
        found.take(u, dot(u, p));
        const bool again = std::any_of(kept.begin(), kept.end(), [&](const Vec &v) { return v[0] == p[0] && v[1] == p[1] && v[2] == p[2]; });
        if (again || found.upper - found.lower <= share * fabsq(found.lower)) break;
        simplex = kept;
        simplex.push_back(p);
        if (simplex.size() > 4) simplex.erase(simplex.begin());
    }
    return found;
}

Found measured(const Case &c, bool single, Real share, int steps) {
    const Difference set(c, single);
    Found found{-HUGE_VALQ, HUGE_VALQ, {}};
    Real size = 0;
    std::vector<Vec> samples;
    for (int k = 0; k < 26; ++k) {
        const int cell = k < 13 ? k : k + 1;
        const Vec u = unit({{static_cast<Real>(cell % 3 - 1), static_cast<Real>(cell / 3 % 3 - 1), static_cast<Real>(cell / 9 - 1)}});
        samples.push_back(set.farthest(u));
        found.take(u, dot(u, samples.back()));
        for (int i = 0; i < 3; ++i) size = std::max(size, fabsq(samples.back()[i]));
    }
    const auto with_ball = [&](Found f) {
        f.lower += set.ball;
        f.upper += set.ball;
        return f;
    };
    if (found.upper < 0) return with_ball(apart(set, found.normal, share));
    // Four corners: the two that are farthest from each other, the one farthest from their line, the one farthest from that plane.
    Vec corner[4] = {samples[0], samples[0], samples[0], samples[0]};
    const auto farthest = [&](auto value) { return *std::max_element(samples.begin(), samples.end(), [&](const Vec &a, const Vec &b) { return value(a) < value(b); }); };
    corner[1] = farthest([&](const Vec &v) { return norm(v - corner[0]); });
    corner[2] = farthest([&](const Vec &v) { return norm(cross(v - corner[0], corner[1] - corner[0])); });
    const Vec plane = cross(corner[1] - corner[0], corner[2] - corner[0]);
    corner[3] = farthest([&](const Vec &v) { return fabsq(dot(v - corner[0], plane)); });
    Polytope polytope;
    if (!polytope.start(corner, size * size * size * 1e-60Q)) return with_ball(apart(set, found.normal, share));
    const Real blur = size * 1e-31Q;
    for (int i = 0; i < steps; ++i) {
        Facet *low = polytope.lowest();
        if (low == nullptr) break;
        const Vec u = low->normal, p = set.farthest(u);
        const Real height = dot(u, p);
        found.take(u, height);
        if (found.upper < 0) return with_ball(apart(set, found.normal, share));
        const Real least = polytope.least();
        found.lower = least > 0 ? least : found.lower;
        if (least > 0 && found.upper - least <= share * (found.upper + set.ball)) break;
        if (height - low->offset <= blur)
            low->done = true;
        else if (!polytope.insert(p, low, blur))
            break;
    }
    if (polytope.least() > 0) return with_ball(found);
    Found distance = apart(set, found.normal, share);
    distance.upper = std::min(distance.upper, found.upper);
    if (distance.upper == found.upper) distance.normal = found.normal;
    return with_ball(distance);
}

void print(Real x) {
    char text[64];
    quadmath_snprintf(text, sizeof text, "%.33Qe", x);
    std::printf(",%s", text);
}

}  // namespace

int main(int argc, char **argv) try {
    if (argc < 2) {
        std::fprintf(stderr, "usage: see the head of oracle.cpp\n");
        return 2;
    }
    bool single = false;
    int at = 2;
    if (at < argc && std::strcmp(argv[at], "float") == 0) {
        single = true;
        ++at;
    }
    const Real share = at < argc ? strtoflt128(argv[at++], nullptr) : 1e-15Q;
    const int steps = at < argc ? std::atoi(argv[at]) : 4000;
    std::printf("case,lower,upper,nx,ny,nz\n");
    for (const Case &c : load_cases(argv[1])) {
        const Found found = measured(c, single, share, steps);
        std::printf("%s", c.id.c_str());
        print(found.lower);
        print(found.upper);
        for (int i = 0; i < 3; ++i) print(found.normal[i]);
        std::printf("\n");
        std::fflush(stdout);
    }
    return 0;
} catch (const std::exception &e) {
    std::fprintf(stderr, "oracle: %s\n", e.what());
    return 1;
}
