//! Text output of `place`.

use kinetostat_analysis::placing::{Candidate, Nowhere, Sensitivity, Space, Why};
use kinetostat_machining::number::{counted, largest};

use crate::placing::answer::PlaceAnswer;
use crate::ui::layout::{columns, item, wrapped};
use crate::ui::numbers::{fixed, number, short, triple};
use crate::ui::warnings::warnings;

fn figure(answer: &PlaceAnswer, value: f64) -> String {
    largest(value, answer.unit)
}

pub(crate) fn answer_text(answer: &PlaceAnswer, space: &Space) -> String {
    let head = format!("{} on {}", answer.program, answer.model);
    let mut out = wrapped(&head, 0);
    out.push('\n');
    let placed = &answer.placed;
    if let Some(best) = &placed.best {
        out.push_str(&wrapped(&verdict(answer, best, space), 2));
        out.push('\n');
        out.push_str(&as_job(best, space));
        out.push_str(&list(answer, space));
        out.push_str(&room(answer));
        out.push_str(&findings(answer));
    }
    out.push_str(&wrapped(
        &format!(
            "{} looked at, {} of the {} {} can be taken. The best ones were solved at all {} of the program.",
            counted(placed.evaluated, "placement"),
            placed.taken,
            placed.samples,
            match space.ranges().is_empty() {
                true => "fixtures",
                false => "that fill the ranges",
            },
            counted(placed.places, "place"),
        ),
        2,
    ));
    out.push_str(&warnings(&answer.warnings));
    out
}

/// Describes the gain of the best placement.
fn verdict(answer: &PlaceAnswer, best: &Candidate, space: &Space) -> String {
    let own = best.figure.unwrap_or(f64::NAN);
    let what = answer.objective.what();
    let compared = |there: Option<f64>, name: &str| match there {
        Some(there) => {
            let change = 100.0 * (1.0 - own / there);
            let by = match change >= 0.0 {
                true => format!("{} % less", number(change, 2)),
                false => format!("{} % more", number(-change, 2)),
            };
            format!("{by} than the {} {name}", figure(answer, there))
        }
        None => format!("{name} the program cannot be run"),
    };
    let line = best
        .line
        .map_or_else(String::new, |line| format!(", on line {line}"));
    let mut sentence = format!(
        "BEST PLACEMENT: the {what} is {}{line}",
        figure(answer, own)
    );
    let placed = &answer.placed;
    let mut than = |there, name: &str| sentence.push_str(&format!("; {}", compared(there, name)));
    if space.ranges().is_empty() {
        // Fixtures alone have no middle.
        if let Some(next) = placed.next_best.first() {
            than(next.figure, "of the next best one");
        }
    } else {
        than(placed.centre.figure, "in the middle of the ranges");
    }
    if space.fixtures().is_empty() {
        than(placed.given, "at the placement as given");
    }
    sentence.push('.');
    sentence
}

/// Placement as text for the job file.
fn as_job(best: &Candidate, space: &Space) -> String {
    let mut out = String::from("  [placement]\n");
    if let Some(fixture) = &best.fixture {
        out.push_str(&format!("  # fixture {fixture}\n"));
    }
    let [x, y, z] = best.part_origin_mm.map(short);
    out.push_str(&format!("  part_origin_mm = [{x}, {y}, {z}]\n"));
    let given = space.given();
    let lies = space.placement(&best.place);
    let quaternion = |q: [f64; 4]| {
        let [w, x, y, z] = q.map(|x| format!("{:.9}", x + 0.0));
        format!("{{ quaternion_wxyz = [{w}, {x}, {y}, {z}] }}")
    };
    if lies.base_from_part.rotation != given.base_from_part.rotation
        || given.base_from_part.rotation.angle() > 0.0
    {
        let written = quaternion(best.part_orientation);
        out.push_str(&format!("  part_orientation = {written}\n"));
    }
    if lies.tool_orientation.angle_to(&given.tool_orientation) > 1e-12 {
        let written = quaternion(best.tool_orientation);
        out.push_str(&format!("  tool_orientation = {written}\n"));
    }
    out.push('\n');
    out
}

fn list(answer: &PlaceAnswer, space: &Space) -> String {
    let mut head = vec![String::new()];
    let with_fixtures = !space.fixtures().is_empty();
    if with_fixtures {
        head.push("fixture".to_owned());
    }
    let names = space.ranges().iter().map(|r| r.variable);
    head.extend(names.map(|v| format!("{}, {}", v.words(), v.unit())));
    head.push(match answer.unit {
        "" => "figure".to_owned(),
        unit => format!("figure, {unit}"),
    });
    head.push("line".to_owned());
    let placed = &answer.placed;
    let row = |(rank, c): (usize, &Candidate)| {
        let mut row = vec![match rank {
            0 => "best".to_owned(),
            _ => (rank + 1).to_string(),
        }];
        if with_fixtures {
            row.push(c.fixture.clone().unwrap_or_default());
        }
        row.extend(c.place.values.iter().map(|value| fixed(*value, 2)));
        row.push(number(c.figure.unwrap_or(f64::NAN), 4));
        row.push(c.line.map_or_else(String::new, |line| line.to_string()));
        row
    };
    let all = placed.best.iter().chain(&placed.next_best);
    let rows: Vec<Vec<String>> = std::iter::once(head)
        .chain(all.enumerate().map(row))
        .collect();
    format!("Best placements\n{}\n", columns(&rows, 2))
}

/// Describes the feasible range around the best placement.
fn room(answer: &PlaceAnswer) -> String {
    let sensitivity = &answer.placed.sensitivity;
    if sensitivity.is_empty() {
        return String::new();
    }
    let head = ["", "down by", "up by", "slope down", "slope up"].map(str::to_owned);
    let row = |s: &Sensitivity| {
        let unit = s.variable.unit();
        let way = |until: Option<f64>| {
            until.map_or_else(
                || "to the end".to_owned(),
                |way| format!("{} {unit}", fixed(way, 1)),
            )
        };
        let per = match answer.unit {
            "" => format!("/{unit}"),
            own => format!(" {own}/{unit}"),
        };
        let slope = |slope: Option<f64>| {
            slope.map_or_else(
                || "-".to_owned(),
                |slope| format!("{}{per}", number(slope, 2)),
            )
        };
        vec![
            s.variable.words().to_owned(),
            way(s.down.until_5_percent_worse),
            way(s.up.until_5_percent_worse),
            slope(s.down.slope),
            slope(s.up.slope),
        ]
    };
    let rows = sensitivity.iter().map(row);
    let rows: Vec<Vec<String>> = std::iter::once(head.to_vec()).chain(rows).collect();
    format!(
        "Room around the best one until the figure is 5 % larger\n{}\n",
        columns(&rows, 2)
    )
}

fn findings(answer: &PlaceAnswer) -> String {
    let findings = &answer.placed.findings;
    if findings.is_empty() {
        return String::new();
    }
    let listed: String = findings
        .iter()
        .map(|finding| item(&finding.message))
        .collect();
    format!("Findings\n{listed}\n")
}

/// Explains why no placement is feasible.
pub(crate) fn nowhere_text(nowhere: &Nowhere, space: &Space) -> String {
    let nearest = &nowhere.nearest;
    let refusal = nearest.refusal.as_ref();
    // Wherever the part lies.
    if let Some(refusal) = refusal.filter(|refusal| refusal.why == Why::NoFigure) {
        return format!("there is nothing to compare: {}", refusal.message);
    }
    let values = space.ranges().iter().zip(&nearest.place.values);
    let at: Vec<String> = nearest
        .fixture
        .iter()
        .map(|name| format!("fixture '{name}'"))
        .chain(values.map(|(range, value)| {
            let (words, unit) = (range.variable.words(), range.variable.unit());
            format!("{words} = {} {unit}", short(*value))
        }))
        .collect();
    let why = nearest
        .refusal
        .as_ref()
        .map_or_else(String::new, |refusal| {
            let line = refusal
                .line
                .map_or_else(String::new, |line| format!("line {line}: "));
            format!(": {line}{} ({})", refusal.message, refusal.why.words())
        });
    // A way of less than half a millimetre is no remedy: the reach is not the reason then.
    let is_way = |by: &[f64; 3]| by.iter().any(|mm| mm.abs() >= 0.5);
    let way = match nowhere.move_mm {
        Some(by) if !is_way(&by) => {
            ". The machine reaches all of it there, and what is said is in the way: widen the ranges, turn the part, or clear it".to_owned()
        }
        Some(by) => format!(
            ". With the part moved by {} mm from there (base axes) all of it would be reached: move the ranges",
            triple(by, |x| fixed(x, 0))
        ),
        None => String::new(),
    };
    format!(
        "the program can be run at no placement inside the ranges. Nearest to it is {}{why}{way}",
        at.join(", ")
    )
}
