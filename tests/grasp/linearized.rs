//! Linearised friction cones: edges by the formulas of the tools, d by all facets of the hull, order and convergence.
use crate::common;
use crate::grasp_common;

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettingsBuilder, DefaultSolver, IPSolver, SupportedConeT};
use common::dice::Dice;
use common::memory::Memory;
use grasp_common::random_contact;
use nalgebra::SMatrix;
use qdist::grasp::{
    Contact, ContactError, Friction, Layout, Norm, Preset, Primitive, PyramidalCone, WrenchFrame, WrenchSet,
    linearized, min_weight, opposed_mean, wrenches,
};
use qdist::qset::Ball;
use qdist::support::Support;
use qdist::{Answer, Options, Vector};

type V3 = Vector<f64, 3>;
type V6 = Vector<f64, 6>;

fn wrench(force: V3, moment: V3) -> V6 {
    Vector::from([force.x, force.y, force.z, moment.x, moment.y, moment.z])
}

/// Contacts around the origin that press about inwards.
fn around(dice: &mut Dice, m: usize, friction: Friction<f64>) -> Vec<(V3, V3, Friction<f64>)> {
    (0..m)
        .map(|_| {
            let p = Vector::from(dice.direction::<3>()) * dice.range(0.7, 1.3);
            let n = (-p.normalize() + Vector::from(dice.direction::<3>()) * 0.2).normalize();
            (p, n, friction)
        })
        .collect()
}

/// The pyramids, with memory of their own.
fn pyramids(
    contacts: &[Contact<f64>],
    frame: &WrenchFrame<f64>,
    layout: &Layout<f64>,
) -> Vec<PyramidalCone<'static, f64>> {
    let count = contacts.iter().map(|c| layout.edges(c.friction())).sum();
    let memory = vec![[0.0; 6]; count].leak();
    let mut out = vec![PyramidalCone::empty(); contacts.len()];
    linearized(contacts, frame, layout, memory, &mut out).unwrap();
    out
}

fn solve(set: &dyn Support<f64, 6>, relative: f64) -> Answer<f64, 6> {
    let mut memory = Memory::new::<f64, 6>(2048, 4096);
    memory.solver::<f64, 6>().solve(set, &Ball::unit(), &Options { relative, ..Options::default() })
}

/// d by brute force: the lowest of all hyperplanes through six points with no point above; 0 when the origin is outside.
fn by_all_facets(points: &[V6]) -> f64 {
    let n = points.len();
    let mut least = f64::MAX;
    let mut index = [0, 1, 2, 3, 4, 5];
    loop {
        let rows = SMatrix::<f64, 6, 6>::from_fn(|i, j| points[index[i]][j]);
        if let Some(plane) = rows.lu().solve(&V6::repeat(1.0)) {
            // plane . p = 1 on it; planes through the origin are found as very long ones.
            let length = plane.norm();
            let above = points.iter().map(|p| plane.dot(p)).fold(f64::NEG_INFINITY, f64::max);
            let below = points.iter().map(|p| plane.dot(p)).fold(f64::INFINITY, f64::min);
            if above <= 1.0 + 1e-9 {
                least = least.min(1.0 / length);
            } else if below >= 1.0 - 1e-9 {
                return 0.0;
            }
        }
        let Some(k) = (0..6).rev().find(|&k| index[k] < n - 6 + k) else { break };
        index[k] += 1;
        (k + 1..6).for_each(|j| index[j] = index[j - 1] + 1);
    }
    least
}

fn points(cones: &[PyramidalCone<'_, f64>]) -> Vec<V6> {
    cones.iter().flat_map(|c| c.edges()).map(|e| Vector::from(*e)).collect()
}

fn assert_same(ours: &[[f64; 6]], theirs: &[V6]) {
    assert_eq!(ours.len(), theirs.len());
    for (a, b) in ours.iter().zip(theirs) {
        assert!((Vector::from(*a) - b).amax() < 1e-13, "{a:?} {b}");
    }
}

/// `wrenchFromFrictionEdge` with the edges of `setUpFrictionEllipsoid`, in millimetres.
#[test]
fn graspit_edges() {
    let mut dice = Dice::new(1);
    for round in 0..40 {
        let center = Vector::from(dice.direction::<3>()) * 0.2;
        let radius = dice.range(0.5, 2.0);
        let mm = dice.pick(&[1.0, 1e-3]);
        let (mu, mus) = (dice.range(0.2, 1.0), dice.range(0.01, 0.5));
        let soft = round % 2 == 0;
        let friction = if soft { Friction::Soft { mu, mus } } else { Friction::Hard { mu } };
        let preset = Preset::graspit(center, radius, mm, Norm::L1).unwrap();
        let (p, mut n, _) = around(&mut dice, 1, friction)[0];
        if round < 4 {
            n = V3::x() * if round < 2 { 1.0 } else { -1.0 };
        }
        let contact = preset.contact(p, n, friction).unwrap();
        let ours = pyramids(&[contact], &preset.frame, &preset.layout);
        let x = if n.x.abs() > 1.0 - 1e-9 { n.cross(&V3::z()) } else { n.cross(&V3::x()) }.normalize();
        let y = n.cross(&x).normalize();
        let quarter = std::f64::consts::FRAC_PI_2;
        let (counts, latitudes) = match soft {
            true => (vec![1, 5, 8, 5, 1], vec![quarter, quarter * 0.5, 0.0, -quarter * 0.5, -quarter]),
            false => (vec![8], vec![0.0]),
        };
        let eccentricity = if soft { mus / mu / mm } else { 1.0 };
        let mut theirs = Vec::new();
        for (count, phi) in counts.into_iter().zip(latitudes) {
            for j in 0..count {
                let theta = f64::from(j) * std::f64::consts::TAU / f64::from(count);
                let v = [theta.cos() * phi.cos(), theta.sin() * phi.cos(), phi.sin()];
                let length = (v[0] * v[0] + v[1] * v[1] + (v[2] / eccentricity).powi(2)).sqrt();
                let force = n + x * (mu * v[0] / length) + y * (mu * v[1] / length);
                let spin = n * (mu * v[2] / length * mm);
                theirs.push(wrench(force, ((p - center).cross(&force) + spin) / radius));
            }
        }
        assert_same(ours[0].edges(), &theirs);
    }
}

/// `friction_cone` and `grasp_matrix`, with the normal force as cap.
#[test]
fn dex_net_edges() {
    let mut dice = Dice::new(2);
    for round in 0..40 {
        let center = Vector::from(dice.direction::<3>()) * 0.2;
        let scale = dice.range(0.5, 2.0);
        let mu = dice.range(0.2, 1.0);
        let friction = if round % 2 == 0 { Friction::Soft { mu, mus: 0.3 } } else { Friction::Hard { mu } };
        let (p, n, _) = around(&mut dice, 1, friction)[0];
        let (finger, force) = (dice.range(0.005, 0.5), dice.range(0.5, 1.0));
        let preset = Preset::dex_net(center, scale, 8, finger).unwrap();
        let contact = preset.contact(p, n, friction).unwrap().with_force_cap(force).unwrap();
        let ours = pyramids(&[contact], &preset.frame, &preset.layout);
        let t1 = (V3::x() - n * n.x).normalize();
        let t2 = n.cross(&t1);
        let mut theirs: Vec<V6> = (0..8)
            .map(|j| {
                let angle = std::f64::consts::TAU * f64::from(j) / 8.0;
                let f = (n + (t1 * angle.cos() + t2 * angle.sin()) * mu) * force;
                wrench(f, (p - center).cross(&f) / scale)
            })
            .collect();
        if round % 2 == 0 {
            let torsion = n * force * (std::f64::consts::PI * finger * finger * mu / scale);
            theirs.extend([wrench(V3::zeros(), torsion), wrench(V3::zeros(), -torsion)]);
        }
        assert_same(ours[0].edges(), &theirs);
    }
}

/// `compute_gOCs` and `compute_primitive_forces`: edges of unit length.
#[test]
fn frogger_edges() {
    let mut dice = Dice::new(3);
    for _ in 0..40 {
        let (mu, lamb, sides) = (dice.range(0.2, 1.0), dice.range(0.3, 3.0), 3 + dice.below(6));
        let friction = Friction::Hard { mu };
        let (p, n, _) = around(&mut dice, 1, friction)[0];
        let preset = Preset::frogger(sides, lamb).unwrap();
        let contact = preset.contact(p, n, friction).unwrap();
        let ours = pyramids(&[contact], &preset.frame, &preset.layout);
        let zeta = Vector::from([1.2, 2.3, 3.4]);
        let tx = (zeta - n * n.dot(&zeta)).normalize();
        let ty = n.cross(&tx);
        let theirs: Vec<V6> = (0..sides)
            .map(|j| {
                let angle = std::f64::consts::TAU * j as f64 / sides as f64;
                let f = (n + (tx * angle.cos() + ty * angle.sin()) * mu) / (1.0 + mu * mu).sqrt();
                assert!((f.norm() - 1.0).abs() < 1e-14);
                wrench(f, p.cross(&f) * lamb.sqrt())
            })
            .collect();
        assert_same(ours[0].edges(), &theirs);
    }
}

/// The numbers of the tools: all facets of their hulls.
#[test]
fn d_is_that_of_all_facets() {
    let mut dice = Dice::new(4);
    let mut closed = [0; 4];
    for round in 0..60 {
        let (mu, mus) = (dice.range(0.5, 1.2), dice.range(0.1, 0.4));
        let (hard, soft) = (Friction::Hard { mu }, Friction::Soft { mu, mus });
        let kind = round % 4;
        let (preset, m, friction) = match kind {
            0 => (Preset::graspit(V3::zeros(), 1.3, 1.0, Norm::L1).unwrap(), 3, hard),
            1 => (Preset::dex_net(V3::zeros(), 1.3, 8, 0.3).unwrap(), 2, soft),
            2 => (Preset::frogger(4, 1.0).unwrap(), 4, hard),
            _ => {
                let mut preset = Preset::graspit(V3::zeros(), 1.0, 1.0, Norm::LInf).unwrap();
                preset.layout = Layout::Inscribed { sides: 3 };
                (preset, 2, soft)
            }
        };
        let mut places = around(&mut dice, m, friction);
        if m == 2 {
            // About opposite.
            places[1].0 = -places[0].0 * 0.9;
            places[1].1 = (-places[0].1 + Vector::from(dice.direction::<3>()) * 0.1).normalize();
        }
        let contacts: Vec<_> = places.iter().map(|&(p, n, f)| preset.contact(p, n, f).unwrap()).collect();
        let cones = pyramids(&contacts, &preset.frame, &preset.layout);
        let mut all = points(&cones);
        if preset.norm == Norm::LInf {
            // All sums of one edge, or none, of each contact.
            all = vec![V6::zeros()];
            for cone in &cones {
                let own: Vec<V6> = cone.edges().iter().map(|e| Vector::from(*e)).collect();
                all =
                    all.iter().flat_map(|sum| core::iter::once(*sum).chain(own.iter().map(move |e| sum + e))).collect();
            }
            all.retain(|p| p.norm() > 0.0);
            if round > 20 {
                continue; // 1.6 million hyperplanes each
            }
        }
        let expected = by_all_facets(&all);
        let answer = solve(&WrenchSet::new(&cones, preset.norm), 1e-9);
        if expected == 0.0 {
            assert!(answer.lower <= 0.0, "{kind} {}", answer.lower);
            continue;
        }
        closed[kind] += 1;
        let slack = 1e-8 * expected;
        assert!(answer.lower <= expected + slack && expected <= answer.upper + slack, "{kind} {expected}");
        assert!(answer.upper - answer.lower < 1e-6 * expected, "{kind} [{} {}]", answer.lower, answer.upper);
    }
    assert!(closed.iter().all(|&n| n > 2), "{closed:?}");
}

/// The min-weight linear program itself.
#[test]
fn min_weights_are_rays() {
    let mut dice = Dice::new(5);
    let mut closed = 0;
    for _ in 0..30 {
        let preset = Preset::frogger(4, 1.0).unwrap();
        let places = around(&mut dice, 4, Friction::Hard { mu: 0.7 });
        let contacts: Vec<_> = places.iter().map(|&(p, n, f)| preset.contact(p, n, f).unwrap()).collect();
        let cones = pyramids(&contacts, &preset.frame, &preset.layout);
        let edges = points(&cones);
        let count = edges.len();
        // Variables α and l: Σ α w = 0, Σ α = 1, α >= l; the largest l.
        let mut rows: Vec<Vec<f64>> = (0..6).map(|i| edges.iter().map(|e| e[i]).chain([0.0]).collect()).collect();
        rows.push((0..=count).map(|j| f64::from(j < count)).collect());
        rows.extend(
            (0..count)
                .map(|k| (0..=count).map(|j| if j == k { -1.0 } else { f64::from(j == count) }).collect::<Vec<f64>>()),
        );
        let b: Vec<f64> = (0..7 + count).map(|i| f64::from(i == 6)).collect();
        let mut cost = vec![0.0; count + 1];
        cost[count] = -1.0;
        let kinds = [SupportedConeT::ZeroConeT(7), SupportedConeT::NonnegativeConeT(count)];
        let settings = DefaultSettingsBuilder::default().verbose(false).build().unwrap();
        let (p, a) = (CscMatrix::zeros((count + 1, count + 1)), CscMatrix::from(&rows));
        let mut lp = DefaultSolver::new(&p, &cost, &a, &b, &kinds, settings).unwrap();
        lp.solve();
        let expected = count as f64 * lp.solution.x[count];
        if !(expected > 1e-3) {
            continue;
        }
        closed += 1;
        let q = opposed_mean(&cones).unwrap();
        let mut memory = Memory::new::<f64, 6>(64, 64);
        let set = WrenchSet::new(&cones, preset.norm);
        let answer = memory.solver::<f64, 6>().solve(&set, &q, &Options { relative: 1e-9, ..Options::default() });
        let (low, high) = (min_weight(answer.lower), min_weight(answer.upper));
        assert!(low - 1e-7 <= expected && expected <= high + 1e-7 && high - low < 1e-7, "{low} {expected} {high}");
    }
    assert!(closed > 5, "{closed}");
}

/// Inside, the cone, outside: in every direction, and by no more than the polygon's share of the friction.
#[test]
fn pyramids_enclose_the_cone() {
    let mut dice = Dice::new(6);
    for _ in 0..200 {
        let contact: Contact<f64> = random_contact(&mut dice, 1.0);
        let frame = WrenchFrame::new(Vector::zeros(), dice.decade(-1.0, 1.0)).unwrap();
        let primitive = Primitive::passive(&contact, &frame).unwrap();
        let sides = 3 + dice.below(30);
        let inner = pyramids(&[contact], &frame, &Layout::Inscribed { sides });
        let outer = pyramids(&[contact], &frame, &Layout::Circumscribed { sides });
        let slack = 1e-13 * (primitive.extent() + outer[0].extent());
        for _ in 0..100 {
            let u = Vector::from(dice.direction::<6>());
            let [low, high] = [&inner[0], &outer[0]].map(|c| c.support(&u).unwrap().dot(&u));
            let h = primitive.value(&u);
            assert!(low <= h + slack && h <= high + slack, "{low} {h} {high}");
            let axis = primitive.center().dot(&u);
            let half = (std::f64::consts::PI / sides as f64).cos();
            let share = match contact.friction() {
                Friction::Soft { .. } => 1.0 / (1.0 + 1.0 / (half * half)).sqrt(),
                _ => half,
            };
            assert!(low - axis >= share * (h - axis) - slack);
            assert!((high - axis) * share <= h - axis + slack);
        }
    }
}

/// d of inscribed pyramids from below, of circumscribed ones from above, both to the exact d as the number of sides grows.
#[test]
fn d_is_enclosed_and_converges() {
    let mut dice = Dice::new(7);
    let mut closed = 0;
    for round in 0..12 {
        let frame = WrenchFrame::new(Vector::zeros(), 1.0).unwrap();
        let norm = if round % 2 == 0 { Norm::L1 } else { Norm::LInf };
        let places = around(&mut dice, 4, Friction::Hard { mu: 0.6 });
        let contacts: Vec<_> = places.iter().map(|&(p, n, f)| Contact::new(p, n, f).unwrap()).collect();
        let mut out = [Primitive::empty(); 4];
        let exact = solve(&WrenchSet::new(wrenches(&contacts, &frame, &mut out).unwrap(), norm), 1e-3);
        if !(exact.lower > 0.02) {
            continue;
        }
        closed += 1;
        let mut gaps = Vec::new();
        for sides in [4, 8, 32] {
            let at = |layout| solve(&WrenchSet::new(&pyramids(&contacts, &frame, &layout), norm), 1e-3);
            let (inner, outer) = (at(Layout::Inscribed { sides }), at(Layout::Circumscribed { sides }));
            assert!(inner.lower <= exact.upper && exact.lower <= outer.upper, "{norm:?} {sides}");
            gaps.push((outer.lower.max(exact.lower) - inner.upper.min(exact.upper)).abs() / exact.upper);
        }
        assert!(gaps[2] < 0.1 * gaps[0] + 3e-3, "{gaps:?}");
    }
    assert!(closed > 3, "{closed}");
}

/// What today's practice misses, on random soft grasps: eight edges, GraspIt!'s 20, and many.
#[test]
fn what_linearising_costs() {
    let mut dice = Dice::new(8);
    let frame = WrenchFrame::new(Vector::zeros(), 1.0).unwrap();
    println!("relative underestimate of d, median: edges 8, 20 (GraspIt!), 66");
    for (norm, m) in [(Norm::L1, 2), (Norm::L1, 5), (Norm::LInf, 3)] {
        let layouts =
            [Layout::Inscribed { sides: 6 }, Layout::GraspIt { millimetre: 1.0 }, Layout::Inscribed { sides: 64 }];
        let mut missed: [Vec<f64>; 3] = Default::default();
        while missed[0].len() < 9 {
            let mut places = around(&mut dice, m, Friction::Soft { mu: 0.5, mus: 0.3 });
            if m == 2 {
                places[1] = (-places[0].0, -places[0].1, places[1].2);
            }
            let contacts: Vec<_> = places.iter().map(|&(p, n, f)| Contact::new(p, n, f).unwrap()).collect();
            let mut out = [Primitive::empty(); 5];
            let exact = solve(&WrenchSet::new(wrenches(&contacts, &frame, &mut out).unwrap(), norm), 1e-2);
            if !(exact.lower > 0.02) {
                continue;
            }
            for (missed, layout) in missed.iter_mut().zip(&layouts) {
                let cones = pyramids(&contacts, &frame, layout);
                let theirs = solve(&WrenchSet::new(&cones, norm), 1e-2);
                assert!(theirs.lower <= exact.upper);
                missed.push(1.0 - theirs.upper.max(0.0) / exact.upper);
            }
        }
        let median = missed.map(|mut shares| {
            shares.sort_by(f64::total_cmp);
            shares[shares.len() / 2]
        });
        println!(
            "{norm:?}, {m} contacts: {:.0} % {:.0} % {:.0} %",
            median[0] * 100.0,
            median[1] * 100.0,
            median[2] * 100.0
        );
        assert!(median[0] > 0.1 && median[0] < 0.8 && median[1] < median[0]);
    }
}

#[test]
fn bad_input_is_named() {
    let frame = WrenchFrame::new(Vector::zeros(), 1.0).unwrap();
    let contact = Contact::new(V3::zeros(), V3::x(), Friction::Hard { mu: 0.5 }).unwrap();
    let soft = Contact::new(V3::zeros(), V3::x(), Friction::Soft { mu: 0.5, mus: 0.1 }).unwrap();
    let mut memory = [[0.0; 6]; 20];
    let mut error = |contact: &Contact<f64>, layout| PyramidalCone::new(contact, &frame, &layout, &mut memory).err();
    for sides in [0, 1, 2, 21, usize::MAX] {
        assert_eq!(error(&contact, Layout::Inscribed { sides }), Some(ContactError::Room), "{sides}");
    }
    assert_eq!(error(&soft, Layout::Inscribed { sides: 19 }), Some(ContactError::Room));
    assert_eq!(error(&soft, Layout::Inscribed { sides: 18 }), None);
    for bad in [f64::NAN, f64::INFINITY, 0.0, -1.0] {
        assert_eq!(error(&soft, Layout::GraspIt { millimetre: bad }), Some(ContactError::Frame));
    }
    for bad in [f64::NAN, f64::INFINITY] {
        assert_eq!(error(&soft, Layout::DexNet { sides: 8, finger_radius: bad }), Some(ContactError::Wrench));
        assert!(Preset::dex_net(V3::zeros(), 1.0, 8, bad).is_err() && Preset::frogger(4, bad).is_err());
    }
    assert!(Preset::graspit(V3::zeros(), 1.0, 0.0, Norm::L1).is_err() && Preset::frogger(4, 0.0).is_err());
    let mut out = [PyramidalCone::empty(); 2];
    let layout = Layout::Inscribed { sides: 8 };
    let mut few = [[0.0; 6]; 15];
    let refused = linearized(&[contact, contact], &frame, &layout, &mut few, &mut out).unwrap_err();
    assert_eq!((refused.contact, refused.error), (1, ContactError::Room));
    assert!(PyramidalCone::<f64>::empty().support(&V6::x()).is_err());
    assert!(opposed_mean::<f64>(&[]).is_none());
    // Without friction all edges are one.
    let bare = Contact::new(V3::zeros(), V3::x(), Friction::Frictionless).unwrap();
    let cones = pyramids(&[bare], &frame, &Layout::GraspIt { millimetre: 1.0 });
    assert!(cones[0].edges().iter().all(|e| *e == [1.0, 0.0, 0.0, 0.0, 0.0, 0.0]));
}
