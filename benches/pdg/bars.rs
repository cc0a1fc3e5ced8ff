//! What has to be reached, against what was measured.

use crate::measure::{Cold, DEFAULT};
use crate::peers::Compared;
use crate::report::{excess, milliseconds};
use crate::scenes::Scenes;
use crate::warm::{LATE, TICK, Warm, Way};
use qdist_cli::mesh::input::Kind;
use qdist_cli::mesh::table::quantile;

/// What was asked, what was found, the bar, and whether it is met (`None`: not measured).
struct Bar {
    what: String,
    found: String,
    bar: String,
    met: Option<bool>,
}

/// How many of these, against a share of them.
fn share<'a>(what: &str, of: impl Iterator<Item = &'a Cold>, least: f64, is: impl Fn(&Cold) -> bool) -> Bar {
    let (mut count, mut missing) = (0, Vec::new());
    for c in of {
        count += 1;
        if !is(c) {
            missing.push(format!("{} {}", c.row.query, c.row.kind.name()));
        }
    }
    let good = count - missing.len();
    let part = good as f64 / (count as f64).max(1.0);
    let names = missing.iter().take(4).cloned().collect::<Vec<_>>().join(", ");
    let names = if missing.is_empty() { String::new() } else { format!(", not {names}") };
    let tail = if missing.len() > 4 { ", ..." } else { "" };
    let found = format!("{good}/{count} = {:.1} %{names}{tail}", 100.0 * part);
    let bar = if least == 1.0 { "all".into() } else { format!(">= {:.0} %", 100.0 * least) };
    Bar { what: what.into(), found, bar, met: (count > 0).then_some(part >= least) }
}

/// The median of the queries of a group, in milliseconds.
fn median(cold: &[&Cold], group: &str, kind: Kind, most: f64) -> Bar {
    let of = || cold.iter().copied().filter(|c| c.row.group == group && c.row.kind == kind);
    let (middle, late) = (milliseconds(of(), 0.5), milliseconds(of(), 0.9));
    let what = format!("cold {}, {group}, median", kind.name());
    let found = format!("{middle:.3} ms, p90 {late:.3} ms");
    Bar { what, found, bar: format!("<= {most} ms"), met: of().next().map(|_| middle <= most) }
}

/// Ours against FCL's: the median over poses of the ratio.
fn ratio(compared: &[Compared], groups: &[&str], contact: bool, distance: bool, most: Option<f64>) -> Vec<Bar> {
    let of_group = |group: &str| {
        let of: Vec<&Compared> = compared.iter().filter(|c| c.group == group && c.contact == contact).collect();
        let times = |c: &Compared| if distance { (c.ours.3, c.fcl.3) } else { (c.ours.1, c.fcl.1) };
        let list = |f: &dyn Fn((f64, f64)) -> f64| quantile(&of.iter().map(|c| f(times(c))).collect::<Vec<_>>(), 0.5);
        let (ours, theirs, ratio) = (list(&|t| t.0 / 1e3), list(&|t| t.1 / 1e3), list(&|t| t.0 / t.1));
        let (query, place) =
            (if distance { "distance" } else { "boolean" }, if contact { "in contact" } else { "moved out" });
        Bar {
            what: format!("{query} over FCL's, {group}, {place}"),
            found: format!("{ratio:.2} ({ours:.1} us, {theirs:.1} us; {} poses)", of.len()),
            bar: most.map_or(String::new(), |most| format!("<= {most}")),
            met: most.filter(|_| !of.is_empty()).map(|most| ratio <= most),
        }
    };
    groups.iter().map(|group| of_group(group)).collect()
}

/// sqrt(sigma) <= DISP <= the best translation, query by query.
fn order(cold: &[&Cold]) -> Bar {
    let holds = |c: &Cold| match c.row.kind {
        Kind::Disp => c.row.translation.is_none_or(|t| c.row.upper <= t * (1.0 + 1e-6)),
        Kind::Sigma => {
            let disp = cold.iter().find(|d| d.row.kind == Kind::Disp && d.row.query == c.row.query);
            disp.is_none_or(|d| c.row.upper <= d.row.upper * (1.0 + 1e-9))
        }
    };
    share("sqrt(sigma) <= DISP <= translation", cold.iter().copied(), 1.0, holds)
}

/// The tracker's time with the haptic example's clock, beside the time without, and its upper bound beside cold ones, 90 % of them and
/// with a background too.
fn tracked(warm: &[Warm]) -> Vec<Bar> {
    let bar = |with: &Warm| {
        let ms = |list: &[f64], share: f64| quantile(list, share) / 1e6;
        let other = |way: Way| warm.iter().find(|w| w.way == way && w.group == with.group && w.kind == with.kind);
        let free = other(Way::Queries).map_or(f64::NAN, |w| ms(&w.times, 0.99));
        let helped = other(Way::Background).map_or(f64::NAN, |w| quantile(&w.ratios, 0.9));
        let [ratio, far] = [0.5, 0.9].map(|share| quantile(&with.ratios, share));
        let awake = if with.awake.is_empty() { f64::NAN } else { ms(&with.awake, 0.99) };
        let [middle, high, most] = [0.5, 0.99, 1.0].map(|share| ms(&with.times, share));
        let found = format!(
            "{middle:.3}, {high:.3} (awake {awake:.3}, no clock {free:.3}), {most:.1} ms; over cold {ratio:.3}, p90 {far:.2} (helped {helped:.2})"
        );
        Bar {
            what: format!("warm {}, {}, late at {} us: p50, p99, max", with.kind.name(), with.group, LATE.as_micros()),
            found,
            bar: "p99 <= 1 ms, over cold <= 1.05".into(),
            met: (!with.ratios.is_empty()).then_some(1e6 * high <= TICK && ratio <= 1.05),
        }
    };
    let mut bars: Vec<_> = warm.iter().filter(|w| w.way == Way::Clock).map(bar).collect();
    let count = |of: fn(&Warm) -> usize| warm.iter().map(of).sum::<usize>();
    let (all, wrong) = (count(|w| w.ratios.len()), count(|w| w.wrong));
    bars.push(Bar {
        what: "warm brackets agree with cold ones, poses free".into(),
        found: format!("{}/{all}", all - wrong),
        bar: "all".into(),
        met: (all > 0).then_some(wrong == 0),
    });
    bars
}

/// One line a bar. `compared` is `None` without FCL.
pub fn summary(scenes: &Scenes, cold: &[Cold], warm: &[Warm], compared: Option<&[Compared]>) -> String {
    let normal: Vec<&Cold> = cold.iter().filter(|c| c.variant == DEFAULT).collect();
    let of = |kind: Kind| normal.iter().copied().filter(move |c| c.row.kind == kind);
    let near = |most: f64| move |c: &Cold| excess(c).is_some_and(|e| e <= most);
    let certified = |most: f64| move |c: &Cold| c.row.lower >= (1.0 - most) * c.row.upper;
    let grouped = |groups: &'static [&str]| move |c: &&Cold| groups.contains(&c.row.group.as_str());
    let narrow = normal.iter().copied().filter(grouped(&["slot", "ring", "special"]));
    let convex = of(Kind::Disp).filter(grouped(&["box"]));
    let benchmarks = of(Kind::Disp).filter(|c| scenes.benchmarks.contains(&c.row.group.as_str()));
    let mut bars = vec![
        share("DISP within 1 % of the best known", of(Kind::Disp), 0.95, near(0.01)),
        share("sigma within 1 % of the best known", of(Kind::Sigma), 0.92, near(0.01)),
        share("slots, rings, plate holes within 1e-3", narrow, 1.0, near(1e-3)),
        share("every pose free by a fresh solid test", cold.iter(), 1.0, |c| c.free),
        share("no bracket contradicts what is known", cold.iter(), 1.0, |c| c.row.contradiction().is_none()),
        share("benchmark pairs, DISP certified within 5 %", benchmarks, 0.6, certified(0.05)),
        share("convex pairs, DISP certified within 1e-6", convex, 1.0, certified(1e-6)),
        order(&normal),
    ];
    if scenes.shared {
        for (kind, limits) in [(Kind::Disp, [2.0, 6.0, 8.0]), (Kind::Sigma, [2.5, 8.0, 10.0])] {
            bars.extend(scenes.benchmarks.iter().zip(limits).map(|(group, most)| median(&normal, group, kind, most)));
        }
    }
    bars.extend(tracked(warm));
    match compared {
        Some(compared) => {
            let groups = scenes.benchmarks.as_slice();
            bars.extend(ratio(compared, groups, true, false, Some(0.5)));
            bars.extend(ratio(compared, groups, true, true, Some(0.6)));
            bars.extend(ratio(compared, groups, false, false, None));
            bars.extend(ratio(compared, groups, false, true, None));
            bars.extend(agreement(compared));
        }
        None => bars.push(Bar {
            what: "boolean, distance over FCL's".into(),
            found: "no FCL".into(),
            bar: "<= 0.5, 0.6".into(),
            met: None,
        }),
    }
    let verdict = |b: &Bar| match b.met {
        _ if b.bar.is_empty() => "",
        Some(true) => "met",
        Some(false) => "MISSED",
        None => "-",
    };
    bars.iter().map(|b| format!("{:48} {:96} {:30} {}\n", b.what, b.found, b.bar, verdict(b))).collect()
}

/// FCL and ours say the same: the answers' poses are free, and distances are equal to 1e-6 of themselves or to rounding.
fn agreement(compared: &[Compared]) -> [Bar; 2] {
    let all = |what: &str, bad: Vec<&Compared>, count: usize| {
        let names = bad.iter().take(3).map(|c| c.query.as_str()).collect::<Vec<_>>().join(", ");
        let names = if bad.is_empty() { names } else { format!(", not {names}") };
        let found = format!("{}/{count}{names}", count - bad.len());
        Bar { what: what.into(), found, bar: "all".into(), met: (count > 0).then_some(bad.is_empty()) }
    };
    let contact = || compared.iter().filter(|c| c.contact);
    // FCL's distance of a pose in collision has no meaning.
    let apart = || compared.iter().filter(|c| !c.ours.0 && !c.fcl.0);
    let differ = |c: &&Compared| (c.ours.2 - c.fcl.2).abs() > 1e-6 * c.fcl.2.abs() + 1e-9;
    [
        all("FCL finds the answers' poses free", contact().filter(|c| c.fcl.0).collect(), contact().count()),
        all("distances equal FCL's", apart().filter(differ).collect(), apart().count()),
    ]
}
