//! The grasps of all grasp files: d of their wrench sets for every kind of Q and every norm, the files' own questions, and what else is asked of
//! grasps: closure, forces, gradients, pyramids. In both scalars, but for the files' own questions.

use std::error::Error;
use std::path::PathBuf;

use nalgebra::SMatrix;
use qdist::grasp::{
    Contact, Finger, ForceModel, ForceOptions, ForceSolver, Friction, HandContact, Jacobian, Layout, Norm, Primitive,
    PyramidalCone, Refined, WrenchFrame, WrenchSet, active_wrenches, default_tolerance, linearized, wrenches,
};
use qdist::qset::{Ball, CrossPolytope, Segment, UnitBox, UnitEllipsoid, UnitSet};
use qdist::{Options, Real, Vector, Workspace};
use qdist_cli::grasp::input::{self, Grasp, Set, norm_name};
use qdist_cli::grasp::sets::{Limited, Part, Sets};

use crate::files;
use crate::line::Record;

type Memory<T> = Box<Workspace<T, 6, 512, 2048>>;
type Done = Result<(), Box<dyn Error>>;

/// Points that a query may add.
const MOST: u32 = 200;
const SETS: [Set; 2] = [Set::Passive, Set::Active];
const NORMS: [Norm; 2] = [Norm::L1, Norm::LInf];

pub fn all(record: &mut Record) -> Done {
    let (mut double, mut single): (Memory<f64>, Memory<f32>) = Default::default();
    let here = files("tests/data", "json").into_iter().map(|file| ("tests/data", file));
    let beside = files("../shared/data/grasps", "json").into_iter().map(|file| ("../shared/data/grasps", file));
    for (folder, file) in here.chain(beside) {
        for grasp in read(&file)? {
            let name = format!("{folder}/{}:{}", file.file_stem().unwrap_or_default().display(), grasp.id);
            let name = name.replace(' ', "_");
            own_questions(record, &name, &grasp, &mut double)?;
            Hand::<f64>::new(&grasp)?.all(record, &name, &mut double)?;
            Hand::<f32>::new(&grasp)?.all(record, &name, &mut single)?;
        }
    }
    Ok(())
}

fn read(file: &PathBuf) -> Result<Vec<Grasp>, Box<dyn Error>> {
    let named = |trouble| format!("{}: {trouble}", file.display());
    Ok(input::read(&std::fs::read_to_string(file)?, false).map_err(named)?)
}

/// To 1e-3, where rounding allows that.
fn options<T: Real>() -> Options<T, 6> {
    Options { relative: T::of(1e-3), max_iterations: MOST, ..Options::default() }
}

/// The questions that the file asks, measured where it means them.
fn own_questions(record: &mut Record, name: &str, grasp: &Grasp, memory: &mut Memory<f64>) -> Done {
    let sets = Sets::of_grasp(grasp)?;
    for (i, query) in grasp.queries.iter().enumerate() {
        let wrenches = sets.get(query.set);
        let set = WrenchSet::new(&wrenches.parts, query.norm);
        let unit = query.q.unit()?;
        let answer = match wrenches.holds(query.set, &query.q) {
            true => memory.solver().solve_in_span(&set, &*unit, &options()),
            false => memory.solver().solve(&set, &*unit, &options()),
        };
        record.answer(&format!("{name}:ref{i}:{}", query.q.kind()), &answer)?;
    }
    Ok(())
}

fn vector<T: Real, const N: usize>(v: &Vector<f64, N>) -> Vector<T, N> {
    v.map(T::of)
}

/// A grasp in a scalar.
struct Hand<T> {
    contacts: Vec<HandContact<T>>,
    fingers: Vec<(Limited, Vec<T>)>,
    frame: WrenchFrame<T>,
}

impl<T: Real> Hand<T> {
    fn new(grasp: &Grasp) -> Result<Self, Box<dyn Error>> {
        let limited = Limited::all(&grasp.contacts)?.into_iter();
        Ok(Self {
            contacts: grasp.contacts.iter().map(|touch| contact(&touch.contact)).collect::<Result<_, _>>()?,
            fingers: limited
                .map(|own| (own.limits.iter().map(|&x| T::of(x)).collect(), own))
                .map(|(t, own)| (own, t))
                .collect(),
            frame: WrenchFrame::new(vector(grasp.frame.reference()), T::of(grasp.frame.torque_scale()))?,
        })
    }

    fn all(&self, record: &mut Record, name: &str, memory: &mut Memory<T>) -> Done {
        for set in SETS {
            let primitives = self.primitives(set)?;
            let parts = self.parts(set, &primitives)?;
            for norm in NORMS {
                let name = format!("{name}:{}:{}", set.name(), norm_name(norm));
                for (kind, unit) in units::<T>()? {
                    let set = WrenchSet::new(&parts, norm);
                    let answer = memory.solver().solve_in_span(&set, &*unit, &options());
                    record.answer(&format!("{name}:{kind}"), &answer)?;
                }
                forces(record, &name, &WrenchSet::new(&parts, norm))?;
                self.beside(record, &name, &WrenchSet::new(&primitives, norm), memory)?;
            }
        }
        self.pyramids(record, name, memory)
    }

    fn primitives(&self, set: Set) -> Result<Vec<Primitive<T>>, Box<dyn Error>> {
        let mut primitives = vec![Primitive::empty(); self.contacts.len()];
        let bare: Vec<_> = self.contacts.iter().map(|own| own.contact).collect();
        match set {
            Set::Passive => wrenches(&bare, &self.frame, &mut primitives)?,
            Set::Active => active_wrenches(&self.contacts, &self.frame, default_tolerance(), &mut primitives)?,
        };
        Ok(primitives)
    }

    /// Fingers with limits, and the contacts of no such finger.
    fn parts(&self, set: Set, primitives: &[Primitive<T>]) -> Result<Vec<Part<T>>, Box<dyn Error>> {
        let model = if set == Set::Passive { ForceModel::Passive } else { ForceModel::Active };
        let mut parts = Vec::new();
        for (own, limits) in &self.fingers {
            let contacts: Vec<_> = own.contacts.iter().map(|&i| self.contacts[i]).collect();
            let finger = Finger::new(&contacts, limits, model, &self.frame, default_tolerance())?;
            parts.push(Part::Finger(Box::new(finger)));
        }
        let alone = |i: &usize| !self.fingers.iter().any(|(own, _)| own.contacts.contains(i));
        parts.extend((0..primitives.len()).filter(alone).map(|i| Part::Contact(Box::new(primitives[i]))));
        Ok(parts)
    }

    /// Closure and gradients.
    fn beside(&self, record: &mut Record, name: &str, set: &WrenchSet<'_, T>, memory: &mut Memory<T>) -> Done {
        let closure = memory.solver().force_closure(set, &options());
        record.line::<T>(&format!("{name}:closure"), &closure, [])?;
        let ball = Ball::unit();
        let coarse = Options { relative: T::of(1e-2), ..options() };
        let answer = memory.solver().solve_in_span(set, &ball, &coarse);
        let refined = Refined::new(set, &ball, &answer);
        record.answer(&format!("{name}:refined:{:?}", refined.kink), &refined.answer)?;
        for (i, own) in self.contacts.iter().enumerate() {
            let gradient = refined.gradient(i, own, &self.frame, default_tolerance());
            record.line::<T>(&format!("{name}:gradient{i}"), &gradient, [])?;
        }
        Ok(())
    }

    /// What tools that linearise friction would say.
    fn pyramids(&self, record: &mut Record, name: &str, memory: &mut Memory<T>) -> Done {
        let bare: Vec<_> = self.contacts.iter().map(|own| own.contact).collect();
        let layouts = [
            Layout::Inscribed { sides: 8 },
            Layout::Circumscribed { sides: 5 },
            Layout::GraspIt { millimetre: T::of(1e-3) },
            Layout::DexNet { sides: 8, finger_radius: T::of(0.005) },
        ];
        for (k, layout) in layouts.iter().enumerate() {
            let mut edges = vec![[T::zero(); 6]; bare.iter().map(|own| layout.edges(own.friction())).sum()];
            let mut cones = vec![PyramidalCone::empty(); bare.len()];
            let cones = linearized(&bare, &self.frame, layout, &mut edges, &mut cones)?;
            for norm in NORMS {
                let answer = memory.solver().solve(&WrenchSet::new(cones, norm), &Ball::unit(), &options());
                record.answer(&format!("{name}:pyramids{k}:{}", norm_name(norm)), &answer)?;
            }
        }
        Ok(())
    }
}

/// The smallest forces against two wrenches, one after the other as in a loop.
fn forces<T: Real>(record: &mut Record, name: &str, set: &WrenchSet<'_, T, Part<T>>) -> Done {
    let mut solver = ForceSolver::new();
    let mut shares = vec![Vector::zeros(); set.contributions().len()];
    for (k, x) in [0.02, 0.025].into_iter().enumerate() {
        let load = Vector::from([0.0, x, -0.1, 0.01, 0.0, 0.02].map(T::of));
        let found = solver.resist(set, &load, &ForceOptions::default(), &mut shares)?;
        let numbers = [&found.lower, &found.upper, &found.residual].into_iter().chain(&found.direction);
        record.line(&format!("{name}:forces{k}"), &found.outcome, numbers.chain(shares.iter().flatten()))?;
    }
    Ok(())
}

/// A Q and the name of its kind.
type Named<T> = (&'static str, Box<dyn UnitSet<T, 6>>);

/// A Q of every kind.
fn units<T: Real>() -> Result<[Named<T>; 5], Box<dyn Error>> {
    let sizes = Vector::from([1.0, 0.75, 1.25, 0.5, 0.625, 0.875].map(T::of));
    let wrench = Vector::from([0.25, -0.125, -1.0, 0.0625, 0.125, -0.25].map(T::of));
    Ok([
        ("ball", Box::new(Ball::unit())),
        ("ellipsoid", Box::new(UnitEllipsoid::new(sizes, SMatrix::identity())?)),
        ("box", Box::new(UnitBox::new(sizes)?)),
        ("cross", Box::new(CrossPolytope::new(sizes)?)),
        ("segment", Box::new(Segment::new(wrench)?)),
    ])
}

fn contact<T: Real>(own: &HandContact<f64>) -> Result<HandContact<T>, Box<dyn Error>> {
    let friction = match own.contact.friction() {
        Friction::Soft { mu, mus } => Friction::Soft { mu: T::of(mu), mus: T::of(mus) },
        Friction::Hard { mu } => Friction::Hard { mu: T::of(mu) },
        Friction::Frictionless => Friction::Frictionless,
    };
    let contact = Contact::new(vector(own.contact.position()), vector(own.contact.normal()), friction)?;
    let [o, t] = own.contact.tangents().each_ref().map(vector);
    let contact = contact.with_tangents(o, t)?.with_force_cap(T::of(own.contact.force_cap()))?;
    let jacobian = own.jacobian.as_ref().map(|jacobian| {
        let entry = |row, column| jacobian.entry(row, column).map_or(T::zero(), T::of);
        let rows: [Vec<T>; 4] = std::array::from_fn(|row| (0..jacobian.joints()).map(|j| entry(row, j)).collect());
        Jacobian::new(rows.each_ref().map(Vec::as_slice))
    });
    Ok(HandContact { contact, jacobian: jacobian.transpose()? })
}
