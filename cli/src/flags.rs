//! The numbers of the command line. Each says what it may be, and clap names the flag.

use std::time::Duration;

use crate::Trouble;

/// A relative tolerance that can be reached.
pub fn tolerance(text: &str) -> Result<f64, Trouble> {
    within(text, |x| x > 0.0 && x < 1.0).ok_or("not a number above 0 and below 1".into())
}

/// A tolerance of which 0 means: as narrow as rounding lets it.
pub fn tolerance_or_none(text: &str) -> Result<f64, Trouble> {
    within(text, |x| (0.0..1.0).contains(&x)).ok_or("not a number from 0 up, below 1".into())
}

/// Some time: a millisecond to a day.
pub fn seconds(text: &str) -> Result<Duration, Trouble> {
    let found = within(text, |x| (1e-3..=86_400.0).contains(&x)).map(Duration::from_secs_f64);
    found.ok_or("not a number of seconds from 0.001 to 86400".into())
}

/// A count from LEAST to MOST; 1e6 is one, too.
pub fn count<const LEAST: u32, const MOST: u32>(text: &str) -> Result<u32, Trouble> {
    let found = within(text, |x| x.fract() == 0.0 && (f64::from(LEAST)..=f64::from(MOST)).contains(&x));
    found.map(|x| x as u32).ok_or(format!("not a whole number from {LEAST} to {MOST}"))
}

fn within(text: &str, fits: impl Fn(f64) -> bool) -> Option<f64> {
    text.parse().ok().filter(|x| fits(*x))
}

/// The request of a line of arguments.
#[cfg(test)]
pub fn parse<R: clap::Args>(arguments: &str) -> Result<R, clap::Error> {
    #[derive(clap::Parser)]
    struct Line<R: clap::Args> {
        #[command(flatten)]
        request: R,
    }
    let words = std::iter::once("qdist").chain(arguments.split_whitespace());
    <Line<R> as clap::Parser>::try_parse_from(words).map(|line| line.request)
}

/// Each of these numbers is refused by the flag's name.
#[cfg(test)]
pub fn refuses<R: clap::Args>(arguments: &str, flag: &str, numbers: &[&str]) {
    for number in numbers {
        let told = parse::<R>(&format!("{arguments} --{flag} {number}")).err().unwrap().to_string();
        assert!(told.contains(&format!("'{number}' for '--{flag}")), "{told}");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_that_make_no_sense() {
        for text in ["", "x", "nan", "NaN", "inf", "-inf", "-1", "-0.1", "1", "2", "1e999", "1e-999x"] {
            assert!(tolerance(text).is_err() && tolerance_or_none(text).is_err(), "{text}");
        }
        assert!(tolerance("0").is_err() && tolerance("1e-999").is_err());
        assert_eq!((tolerance("1e-6"), tolerance_or_none("0")), (Ok(1e-6), Ok(0.0)));
        for text in ["", "nan", "inf", "-1", "0", "1e9"] {
            assert!(seconds(text).is_err(), "{text}");
        }
        assert_eq!(seconds("0.5"), Ok(Duration::from_millis(500)));
        for text in ["", "x", "nan", "inf", "-1", "0", "1.5", "1001", "1e9", "1e999"] {
            assert_eq!(count::<1, 1000>(text).unwrap_err(), "not a whole number from 1 to 1000", "{text}");
        }
        assert_eq!((count::<1, 1000>("1"), count::<0, 1000>("1e3")), (Ok(1), Ok(1000)));
    }
}
