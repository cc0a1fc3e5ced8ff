//! Lines of a record.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

use qdist::{Answer, Real};

/// A file of lines, each of them words with a space between.
pub struct Record {
    out: BufWriter<File>,
    lines: usize,
}

impl Record {
    pub fn new(file: &Path) -> io::Result<Self> {
        Ok(Self { out: BufWriter::new(File::create(file)?), lines: 0 })
    }

    /// What was asked, how it ended, and the bits of numbers.
    pub fn line<'a, T: Real>(
        &mut self,
        question: &str,
        outcome: &dyn std::fmt::Debug,
        numbers: impl IntoIterator<Item = &'a T>,
    ) -> io::Result<()> {
        let single = size_of::<T>() == size_of::<f32>();
        let outcome = format!("{outcome:?}").replace(' ', "");
        write!(self.out, "{question} {} {outcome}", if single { "f32" } else { "f64" })?;
        for number in numbers {
            let number = number.to_f64();
            match single {
                // Exact: the number comes from there.
                true => write!(self.out, " {:08x}", (number as f32).to_bits())?,
                false => write!(self.out, " {:016x}", number.to_bits())?,
            }
        }
        self.lines += 1;
        writeln!(self.out)
    }

    /// An answer about d_Q: bracket, direction, its support point, and what the lower bound stands on.
    pub fn answer<T: Real, const N: usize>(&mut self, question: &str, answer: &Answer<T, N>) -> io::Result<()> {
        let corners = answer.witness.corners.iter().flat_map(|corner| &corner.vertex.point);
        let numbers = [&answer.lower, &answer.upper, &answer.unit].into_iter();
        let numbers = numbers.chain(&answer.direction).chain(&answer.support).chain(corners);
        self.line(question, &(answer.outcome, answer.plan, answer.dimension), numbers)
    }

    /// The number of lines.
    pub fn end(mut self) -> io::Result<usize> {
        self.out.flush()?;
        Ok(self.lines)
    }
}
