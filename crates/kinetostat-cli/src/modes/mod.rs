//! `kinetostat modes`: at which frequencies a machine vibrates at a place, and what moves.
//!
//! It takes a model, a place, a load, what holds the tool and damping, and gives signed frequencies, the motion of the tool,
//! shares of kinetic and elastic energy, and the count of all directions.

mod answer;
pub(crate) mod arguments;
mod fields;
mod text;

use kinetostat::Posture;
use kinetostat_analysis::vibration::VibratingMachine;
use kinetostat_diagnostic::ErrorCode;
use kinetostat_dynamics::{ComplexMode, Damping, Mode, ModeKind};
use kinetostat_report::{Drawing, Magnified, Moved, Placed};

use crate::files::answer_files::{ClaimedFiles, Shown};
use crate::modes::answer::answer;
use crate::modes::arguments::ModesArgs;
use crate::place::query::PlaceQuery;
use crate::ui::failure::{Answer, Failing};
use crate::ui::numbers::number;
use crate::ui::result_form::ResultForm;
use crate::vibration::pair::{frequency_hz, growth_per_s};
use crate::vibration::subject::refused;
use crate::vibration::{small_step, subject};

/// Results that the command gives as JSON.
pub(crate) const RESULTS: &[ResultForm] =
    &[ResultForm::of::<fields::ModesAnswer>("modes of vibration")];

pub(crate) fn run(args: &ModesArgs) -> Answer<()> {
    if args.modes == 0 {
        return Err(ErrorCode::Value.failure("--modes is 0; ask for one at least"));
    }
    let query = subject::query(&args.machine)?;
    let damping = args.damping.law(&query.damping)?;
    let held = subject::held(args.hold.as_deref())?;
    let files = ClaimedFiles::claim(&args.outputs, &query.inputs)?;
    let posture = query.posture()?;
    let machine = subject::machine(&query, &posture, &held)?;
    let answer = answer(args, &query, &posture, &machine, &damping)?;
    let svg = match args.outputs.plot.is_some() {
        true => drawn(&query, &posture, &machine, &damping, args.modes)?,
        false => String::new(),
    };
    let shown = Shown {
        text: text::answer_text(&query, &answer),
        csv: text::table(&answer)?,
        svg,
        failure: None,
    };
    files.finish(&shown, &answer)
}

/// Upper limit of the modes of one drawing.
const MOST: usize = 6;
/// Size of a drawn phase, px.
const WIDTH: usize = 560;
const HEIGHT: usize = 470;

/// A mode or a complex pair as it is drawn.
struct Drawn {
    /// Frequency and what becomes of it.
    words: String,
    /// Motion of the first phase, and of the second.
    phases: [Mode; 2],
    degrees: [u32; 2],
}

/// A pair whose parts swing out of step by more than this share is drawn a quarter of a period later.
const STEP: f64 = 1e-3;

fn of_mode(mode: &Mode) -> Drawn {
    let kind = match mode.kind {
        ModeKind::Free => ", free",
        ModeKind::Unstable => ", UNSTABLE",
        _ => "",
    };
    let mut back = mode.clone();
    back.shape.neg_mut();
    Drawn {
        words: format!("{} Hz{kind}", number(mode.frequency_hz(), 4)),
        phases: [mode.clone(), back],
        degrees: [90, 270],
    }
}

fn of_pair(machine: &VibratingMachine, pair: &ComplexMode) -> Drawn {
    let [first, later] = machine.dynamics.shapes_of_pair(pair);
    let growth = growth_per_s(pair);
    let kind = match (growth, pair.grows()) {
        (0.0, _) => String::new(),
        (_, true) => format!(", GROWS by {} 1/s", number(growth, 3)),
        (_, false) => format!(", dies away by {} 1/s", number(-growth, 3)),
    };
    let in_step = later.shape.amax() <= STEP * first.shape.amax();
    let mut back = first.clone();
    back.shape.neg_mut();
    Drawn {
        words: format!("{} Hz{kind}", number(frequency_hz(pair), 4)),
        phases: [first, if in_step { back } else { later }],
        degrees: if in_step { [90, 270] } else { [90, 180] },
    }
}

/// The lowest modes below each other, two phases side by side: those in which the machine turns back, or of a complex pair
/// whose parts swing out of step that in which the tool moves farthest and one a quarter of a period later.
fn drawn(
    query: &PlaceQuery,
    posture: &Posture,
    machine: &VibratingMachine,
    damping: &Damping,
    modes: usize,
) -> Answer<String> {
    let modes = modes.min(MOST);
    let complex = machine.complex_modes(damping, modes).map_err(refused)?;
    let list: Vec<Drawn> = match &complex {
        None => (machine.modes.modes.iter().take(modes))
            .map(of_mode)
            .collect(),
        Some(found) => (found.modes.iter())
            .map(|pair| of_pair(machine, pair))
            .collect(),
    };
    // One camera for all: drawings that are compared are seen from one side and in one size.
    let set: Vec<Moved> = (list.iter())
        .flat_map(|mode| [0, 1].map(|column| moved(posture, machine, mode, column)))
        .collect();
    let (width, height) = (2 * WIDTH, HEIGHT * list.len());
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\">\n"
    );
    for (row, mode) in list.iter().enumerate() {
        for column in 0..2 {
            let panel = phase(query, &set, row, mode, column);
            let place = format!(
                "<svg x=\"{}\" y=\"{}\" width=\"{WIDTH}\" height=\"{HEIGHT}\"",
                column * WIDTH,
                row * HEIGHT
            );
            out.push_str(&nested(&panel, &place));
            out.push('\n');
        }
    }
    out.push_str("</svg>\n");
    Ok(out)
}

/// A drawing with other sizes in its first element.
fn nested(svg: &str, head: &str) -> String {
    let Some(begin) = svg.find("<svg") else {
        return String::new();
    };
    let Some(end) = svg[begin..].find('>') else {
        return String::new();
    };
    let (own, rest) = svg[begin..].split_at(end);
    let kept = own["<svg".len()..]
        .split_inclusive('"')
        .collect::<Vec<_>>()
        .chunks(2)
        .filter(|pair| {
            let name = pair[0].trim_start();
            !["width=", "height=", "x=", "y="]
                .iter()
                .any(|start| name.starts_with(start))
        })
        .flat_map(|pair| pair.iter().copied())
        .collect::<String>();
    format!("{head}{kept}{rest}")
}

/// Motion of a mode in a phase, from the equilibrium on.
fn moved(posture: &Posture, machine: &VibratingMachine, mode: &Drawn, column: usize) -> Moved {
    // Both phases are drawn with the same step.
    let step = small_step(&mode.phases[0]);
    let moved_in = machine.moved_in(posture, &mode.phases[column], step);
    Moved {
        from: Placed::solved(posture, &machine.equilibrium.state),
        to: Placed::solved(posture, &moved_in),
        magnified: Magnified::Direction,
        name: "moved as in the mode".to_owned(),
    }
}

fn phase(query: &PlaceQuery, set: &[Moved], index: usize, mode: &Drawn, column: usize) -> String {
    let own = set[2 * index + column].clone();
    let mut drawing = Drawing::of(&query.mechanism, own.from.clone());
    drawing.title = format!(
        "{}, mode {}: {}, phase {} deg",
        query.name,
        index + 1,
        mode.words,
        mode.degrees[column]
    );
    drawing.moved = Some(own);
    drawing.set = set;
    drawing.svg().0
}
