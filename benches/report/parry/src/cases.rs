//! Reads the case files (`tests/data/README.md` has the format), as `ffi-tests/cases.cpp` does.

use parry3d_f64::math::{Matrix, Pose, Rotation, Vector};

pub enum Form {
    Sphere(f64),
    Box(Vector),
    Ellipsoid(Vector),
    /// Radius and half height, along z.
    Cylinder(f64, f64),
    Capsule(f64, f64),
    /// Its apex is at +z.
    Cone(f64, f64),
    Hull(Vec<Vector>),
}

pub struct Case {
    pub id: String,
    pub bodies: [(Form, Pose); 2],
}

pub fn load(path: &str) -> Result<Vec<Case>, String> {
    let text = std::fs::read_to_string(path).map_err(|e| format!("{path}: {e}"))?;
    let mut tokens = Tokens(text.split_ascii_whitespace());
    let mut cases = Vec::new();
    while let Some(word) = tokens.0.next() {
        let id = if word == "CASE" {
            tokens.word()?.to_owned()
        } else {
            return Err(format!("{path}: expected 'CASE', found '{word}'"));
        };
        let case = tokens.case(id.clone()).map_err(|e| format!("{path}, case {id}: {e}"))?;
        cases.push(case);
    }
    Ok(cases)
}

struct Tokens<'a>(std::str::SplitAsciiWhitespace<'a>);

impl<'a> Tokens<'a> {
    fn word(&mut self) -> Result<&'a str, String> {
        self.0.next().ok_or_else(|| "ends early".to_owned())
    }

    fn expect(&mut self, what: &str) -> Result<(), String> {
        let word = self.word()?;
        if word == what { Ok(()) } else { Err(format!("expected '{what}', found '{word}'")) }
    }

    fn number<T: std::str::FromStr>(&mut self) -> Result<T, String> {
        let word = self.word()?;
        word.parse().map_err(|_| format!("not a number: '{word}'"))
    }

    fn vector(&mut self) -> Result<Vector, String> {
        Ok(Vector::new(self.number()?, self.number()?, self.number()?))
    }

    fn case(&mut self, id: String) -> Result<Case, String> {
        let bodies = [self.body()?, self.body()?];
        // The reference is not for solvers.
        self.expect("T")?;
        for _ in 0..7 {
            self.number::<f64>()?;
        }
        Ok(Case { id, bodies })
    }

    fn body(&mut self) -> Result<(Form, Pose), String> {
        self.expect("S")?;
        let form = self.form()?;
        self.expect("P")?;
        let rows = [self.vector()?, self.vector()?, self.vector()?];
        // Poses of parry are quaternions: a matrix that turns to within rounding is changed by rounding.
        let rotation = Rotation::from_mat3(&Matrix::from_cols(rows[0], rows[1], rows[2]).transpose());
        Ok((form, Pose::from_parts(self.vector()?, rotation)))
    }

    fn form(&mut self) -> Result<Form, String> {
        let name = self.word()?;
        let count: usize = self.number()?;
        Ok(match (name, count) {
            ("sphere", 1) => Form::Sphere(self.number()?),
            ("box", 3) => Form::Box(self.vector()?),
            ("ellipsoid", 3) => Form::Ellipsoid(self.vector()?),
            ("cylinder", 2) => Form::Cylinder(self.number()?, self.number()?),
            ("capsule", 2) => Form::Capsule(self.number()?, self.number()?),
            ("cone", 2) => Form::Cone(self.number()?, self.number()?),
            ("hull", _) => Form::Hull((0..count).map(|_| self.vector()).collect::<Result<_, _>>()?),
            _ => return Err(format!("unknown shape '{name}' with {count} numbers")),
        })
    }
}
