//! Reads grasps from a JSON file and prints what their contacts and fingers can do, and how well the support functions
//! of their wrench sets agree with the references in the file.
//!
//! ```text
//! cargo run --release --features std,grasp --example grasp -- ../shared/data/grasps/grasps.json
//! ```
//!
//! The file has a list `instances`. A grasp has `id`, `contacts` and `refs`. A contact has `p`, `n`, `o`, `t`, `type`
//! (`soft`, `hard`, `frictionless`), `mu`, `mus` and, for a finger, the rows `J` of its Jacobian; all in units where
//! the torque scale is 1. A reference has `set` (`W`, `Wa`), `norm` (`L1`, `Linf`), `Q`, `d` and, usually, the
//! `direction` where h_W / h_Q is d: in the coordinates of R^6, of the columns of `R` or of the rows of `Q.S`; for an
//! ellipsoid Q = D B it is D u.

use std::fmt::Write;
use std::process::ExitCode;

use qdist::Vector;
use qdist::grasp::{
    ActiveForces, Contact, ContactError, Friction, GraspError, HandContact, Jacobian, Norm, Primitive, Subspace,
    WrenchFrame, WrenchSet, active_wrenches, default_tolerance, wrenches,
};
use serde_json::Value;

/// What is wrong with a file, in words.
type Trouble = String;

fn numbers(v: &Value, key: &str) -> Result<Vec<f64>, Trouble> {
    let list = v[key].as_array().ok_or(format!("`{key}` is not a list"))?;
    list.iter().map(|x| x.as_f64().ok_or(format!("`{key}` has an entry that is not a number"))).collect()
}

fn rows(v: &Value, key: &str) -> Result<Vec<Vec<f64>>, Trouble> {
    let list = v[key].as_array().ok_or(format!("`{key}` is not a list of rows"))?;
    list.iter().map(|row| numbers(&serde_json::json!({ key: row }), key)).collect()
}

fn vector<const N: usize>(v: &Value, key: &str) -> Result<Vector<f64, N>, Trouble> {
    let list: [f64; N] = numbers(v, key)?.try_into().map_err(|_| format!("`{key}` has not {N} numbers"))?;
    Ok(Vector::from(list))
}

fn number(v: &Value, key: &str) -> Result<f64, Trouble> {
    v[key].as_f64().ok_or(format!("`{key}` is not a number"))
}

fn text<'a>(v: &'a Value, key: &str) -> Result<&'a str, Trouble> {
    v[key].as_str().ok_or(format!("`{key}` is not a text"))
}

fn list<'a>(v: &'a Value, key: &str) -> Result<&'a [Value], Trouble> {
    Ok(v[key].as_array().ok_or(format!("`{key}` is not a list"))?)
}

fn hand_contact(v: &Value) -> Result<HandContact<f64>, Trouble> {
    let friction = match text(v, "type")? {
        "soft" => Friction::Soft { mu: number(v, "mu")?, mus: number(v, "mus")? },
        "hard" => Friction::Hard { mu: number(v, "mu")? },
        "frictionless" => Friction::Frictionless,
        other => return Err(format!("`type` is {other:?}, not soft, hard or frictionless")),
    };
    let words = |error: ContactError| error.to_string();
    let contact = Contact::new(vector(v, "p")?, vector(v, "n")?, friction).map_err(words)?;
    let contact = contact.with_tangents(vector(v, "o")?, vector(v, "t")?).map_err(words)?;
    let jacobian = match v["J"].is_null() {
        true => None,
        false => {
            let rows = rows(v, "J")?;
            let [n, o, t, spin] = rows.as_slice() else { return Err("`J` has not 4 rows".into()) };
            Some(Jacobian::new([n, o, t, spin]).map_err(words)?)
        }
    };
    Ok(HandContact { contact, jacobian })
}

/// A grasp and its sets, ready for queries.
struct Grasp {
    hand: Vec<HandContact<f64>>,
    frame: WrenchFrame<f64>,
    passive: Vec<Primitive<f64>>,
    active: Vec<Primitive<f64>>,
}

impl Grasp {
    fn read(v: &Value) -> Result<Self, Trouble> {
        let contacts = list(v, "contacts")?.iter().enumerate();
        let hand: Vec<_> = contacts
            .map(|(i, c)| hand_contact(c).map_err(|trouble| format!("contact {i}: {trouble}")))
            .collect::<Result<_, _>>()?;
        let frame = WrenchFrame::new(Vector::zeros(), 1.0).map_err(|e| e.to_string())?;
        let words = |error: GraspError| error.to_string();
        let contacts: Vec<_> = hand.iter().map(|c| c.contact).collect();
        let (mut passive, mut active) = (vec![Primitive::empty(); hand.len()], vec![Primitive::empty(); hand.len()]);
        wrenches(&contacts, &frame, &mut passive).map_err(words)?;
        active_wrenches(&hand, &frame, default_tolerance(), &mut active).map_err(words)?;
        Ok(Self { hand, frame, passive, active })
    }

    /// What each contact's joints can do.
    fn fingers(&self) -> Result<String, Trouble> {
        let mut line = String::new();
        for HandContact { contact, jacobian } in &self.hand {
            let entry = match jacobian {
                None => "passive".to_string(),
                Some(jacobian) => {
                    let forces = ActiveForces::new(contact, jacobian, &self.frame, default_tolerance());
                    let forces = forces.map_err(|e| e.to_string())?;
                    let size = match forces.dimension() {
                        None => "no active force".to_string(),
                        Some(dimension) => format!("{dimension}-D disc"),
                    };
                    format!("rank {}, {size}", forces.rank())
                }
            };
            let separator = if line.is_empty() { "" } else { "; " };
            write!(line, "{separator}{entry}").map_err(|e| e.to_string())?;
        }
        Ok(line)
    }
}

/// h_W / h_Q at the direction of a reference; `None` when it has none.
fn value(grasp: &Grasp, r: &Value) -> Result<Option<f64>, Trouble> {
    if r["direction"].is_null() {
        return Ok(None);
    }
    let (q, mut u) = (&r["Q"], numbers(r, "direction")?);
    let norm = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    let scaled = |u: &[f64], key: &str| -> Result<Vec<f64>, Trouble> {
        Ok(numbers(q, key)?.iter().zip(u).map(|(a, x)| (a * x).abs()).collect())
    };
    let gauge = match text(q, "type")? {
        "ball" => norm(&u),
        "ellipsoid" => {
            let gauge = norm(&u);
            u.iter_mut().zip(numbers(q, "semi_axes")?).for_each(|(x, a)| *x /= a);
            gauge
        }
        "box" => scaled(&u, "half_widths")?.iter().sum(),
        "cross_polytope" => scaled(&u, "half_axes")?.into_iter().fold(0.0, f64::max),
        "segment" => numbers(q, "wrench")?.iter().zip(&u).map(|(a, x)| a * x).sum(),
        other => return Err(format!("`Q.type` {other:?} is not known")),
    };
    let axes: Vec<Vec<f64>> = if !r["R"].is_null() {
        let rows = rows(r, "R")?;
        (0..u.len()).map(|k| rows.iter().filter_map(|row| row.get(k).copied()).collect()).collect()
    } else if !q["S"].is_null() {
        rows(q, "S")?
    } else {
        (0..6).map(|i| (0..6).map(|j| if i == j { 1.0 } else { 0.0 }).collect()).collect()
    };
    if axes.len() != u.len() || axes.iter().any(|axis| axis.len() != 6) {
        return Err("`direction` does not fit its space".into());
    }
    let u = axes.iter().zip(&u).fold(Vector::zeros(), |s, (axis, x)| s + Vector::from_column_slice(axis) * *x);
    let primitives = if text(r, "set")? == "Wa" { &grasp.active } else { &grasp.passive };
    let measure = if text(r, "norm")? == "L1" { Norm::L1 } else { Norm::LInf };
    Ok(Some(WrenchSet::new(primitives, measure).value(&u) / gauge))
}

fn report(v: &Value) -> Result<(), Trouble> {
    let grasp = Grasp::read(v)?;
    let dimension = |p: &[Primitive<f64>]| Subspace::new(p, default_tolerance()).map(|s| s.dimension());
    let [passive, active] = [dimension(&grasp.passive), dimension(&grasp.active)].map(|d| d.map_err(|e| e.to_string()));
    println!("  {}", grasp.fingers()?);
    println!("  dimension of W {}, of W^a {}", passive?, active?);
    println!("  {:>3}  {:<3} {:<5} {:<15} {:>14} {:>14} {:>9}", "ref", "set", "norm", "Q", "d", "h_W/h_Q", "relative");
    for (i, r) in list(v, "refs")?.iter().enumerate() {
        let (d, q) = (number(r, "d")?, text(&r["Q"], "type")?);
        print!("  {i:>3}  {:<3} {:<5} {q:<15} {d:>14.10}", text(r, "set")?, text(r, "norm")?);
        match value(&grasp, r).map_err(|trouble| format!("ref {i}: {trouble}"))? {
            Some(h) if d > 0.0 => println!(" {h:>14.10} {:>9.1e}", (h - d) / d),
            Some(h) => println!(" {h:>14.10}"),
            None => println!(),
        }
    }
    Ok(())
}

fn run(file: &str) -> Result<(), Trouble> {
    let text = std::fs::read_to_string(file).map_err(|e| format!("{file}: {e}"))?;
    let data: Value = serde_json::from_str(&text).map_err(|e| format!("{file}: {e}"))?;
    for (i, v) in list(&data, "instances")?.iter().enumerate() {
        let id = v["id"].as_str().map_or(format!("grasp {i}"), str::to_string);
        println!("{id}");
        report(v).map_err(|trouble| format!("{id}: {trouble}"))?;
    }
    Ok(())
}

fn main() -> ExitCode {
    let Some(file) = std::env::args().nth(1) else {
        eprintln!("usage: grasp FILE.json");
        return ExitCode::from(2);
    };
    match run(&file) {
        Ok(()) => ExitCode::SUCCESS,
        Err(trouble) => {
            eprintln!("{trouble}");
            ExitCode::FAILURE
        }
    }
}
