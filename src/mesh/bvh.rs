//! A binary tree of boxes over the triangles of a mesh, in the mesh's own frame.
//!
//! All boxes of a mesh share its axes, so for a pair of meshes the relative rotation and its absolute values are
//! computed once per query, and a pair of boxes costs a few dozen multiplications. A node is one cache line; the two children of a node are
//! neighbours; a leaf is one triangle. Built top-down by the surface area heuristic over 64 bins.

use nalgebra::{Point3, Vector3};

/// A box around some of the triangles.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Node {
    pub centre: Vector3<f64>,
    pub half: Vector3<f64>,
    /// Sum of the half extents: the larger box of a pair is opened first.
    pub size: f64,
    /// The first of two children, or the triangle of a leaf.
    link: u32,
    leaf: bool,
}

/// What is below a node.
pub(super) enum Below {
    Children([u32; 2]),
    Triangle(u32),
}

impl Node {
    fn around(low: Vector3<f64>, high: Vector3<f64>) -> Node {
        // Rounded outward: the halves are computed with an error of an ulp of the coordinates.
        let centre = (low + high) * 0.5;
        let pad = 4.0 * f64::EPSILON * (low.abs() + high.abs());
        let half = (high - low) * 0.5 + pad;
        Node { centre, half, size: half.sum(), link: 0, leaf: false }
    }

    #[inline]
    pub fn below(&self) -> Below {
        if self.leaf { Below::Triangle(self.link) } else { Below::Children([self.link, self.link + 1]) }
    }

    #[inline]
    pub fn is_leaf(&self) -> bool {
        self.leaf
    }
}

/// The tree; the root is node 0.
#[derive(Clone, Debug)]
pub(super) struct Bvh {
    nodes: Vec<Node>,
}

#[derive(Clone, Copy)]
struct Bin {
    count: u32,
    low: Vector3<f64>,
    high: Vector3<f64>,
}

const EMPTY: Bin =
    Bin { count: 0, low: Vector3::new(f64::MAX, f64::MAX, f64::MAX), high: Vector3::new(f64::MIN, f64::MIN, f64::MIN) };

impl Bin {
    fn add(&mut self, low: &Vector3<f64>, high: &Vector3<f64>, count: u32) {
        self.low = self.low.inf(low);
        self.high = self.high.sup(high);
        self.count += count;
    }

    /// Number of triangles times half the surface of their box.
    fn cost(&self) -> f64 {
        if self.count == 0 {
            return 0.0;
        }
        let e = self.high - self.low;
        f64::from(self.count) * (e.x * e.y + e.y * e.z + e.z * e.x)
    }
}

struct Item {
    low: Vector3<f64>,
    high: Vector3<f64>,
    middle: Vector3<f64>,
    triangle: u32,
}

const BINS: usize = 64;

impl Bvh {
    /// Of at least one triangle. O(n log n).
    pub fn new(corners: &[[Point3<f64>; 3]]) -> Bvh {
        let mut items: Vec<Item> = corners
            .iter()
            .enumerate()
            .map(|(i, [a, b, c])| {
                let low = a.coords.inf(&b.coords).inf(&c.coords);
                let high = a.coords.sup(&b.coords).sup(&c.coords);
                Item { low, high, middle: (low + high) * 0.5, triangle: i as u32 }
            })
            .collect();
        let mut nodes = Vec::with_capacity(2 * items.len());
        nodes.push(Node::around(Vector3::zeros(), Vector3::zeros()));
        let mut tasks = vec![(0usize, 0usize, items.len())];
        while let Some((node, from, to)) = tasks.pop() {
            let range = &mut items[from..to];
            let mut all = EMPTY;
            range.iter().for_each(|item| all.add(&item.low, &item.high, 1));
            nodes[node] = Node::around(all.low, all.high);
            if let [item] = range {
                nodes[node].leaf = true;
                nodes[node].link = item.triangle;
                continue;
            }
            let half = from + split(range);
            let link = nodes.len();
            nodes[node].link = link as u32;
            nodes.extend([nodes[node]; 2]);
            tasks.extend([(link, from, half), (link + 1, half, to)]);
        }
        Bvh { nodes }
    }

    #[inline]
    pub fn node(&self, i: u32) -> &Node {
        &self.nodes[i as usize]
    }

    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    pub fn root(&self) -> &Node {
        &self.nodes[0]
    }
}

/// Reorders the items; returns how many go to the first child, at least 1 and less than all of at least two.
fn split(items: &mut [Item]) -> usize {
    let mut centres = EMPTY;
    items.iter().for_each(|item| centres.add(&item.middle, &item.middle, 1));
    let extent = centres.high - centres.low;
    let mut best = (f64::MAX, 0, 0);
    for axis in 0..3 {
        if !(extent[axis] > 0.0) {
            continue;
        }
        let mut bins = [EMPTY; BINS];
        for item in items.iter() {
            bins[bin_of(item, axis, &centres, &extent)].add(&item.low, &item.high, 1);
        }
        let mut right_cost = [0.0; BINS];
        let mut right = EMPTY;
        for i in (1..BINS).rev() {
            right.add(&bins[i].low, &bins[i].high, bins[i].count);
            right_cost[i] = right.cost();
        }
        let mut left = EMPTY;
        for i in 1..BINS {
            left.add(&bins[i - 1].low, &bins[i - 1].high, bins[i - 1].count);
            let cost = left.cost() + right_cost[i];
            if cost < best.0 && left.count > 0 && (left.count as usize) < items.len() {
                best = (cost, axis, i);
            }
        }
    }
    let (cost, axis, bin) = best;
    if cost == f64::MAX {
        return items.len() / 2;
    }
    let mut first = 0;
    for i in 0..items.len() {
        if bin_of(&items[i], axis, &centres, &extent) < bin {
            items.swap(i, first);
            first += 1;
        }
    }
    first.clamp(1, items.len() - 1)
}

fn bin_of(item: &Item, axis: usize, centres: &Bin, extent: &Vector3<f64>) -> usize {
    let x = (item.middle[axis] - centres.low[axis]) / extent[axis];
    ((x * BINS as f64) as usize).min(BINS - 1)
}
