//! Figures 6.6 and 6.7: milling along the line from Q2 to Q5, legs with errors [R 6.5.2].

use kinetostat::number::larger;
use kinetostat::{Mechanism, Wrench};
use kinetostat_report::{Plot, PlotLine};
use nalgebra::Vector3;
use rayon::prelude::*;

use crate::orthoglide::machine::{LARGE, Orthoglide, SMALL, cutting, target};
use crate::{Cause, Contents, Item};

/// Displacement of the tool from its target for each source of error, mm.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sources {
    /// The cutting force alone.
    pub(super) force: Vector3<f64>,
    /// The errors of the legs alone.
    pub(super) errors: Vector3<f64>,
    /// Displacement by both together.
    pub(super) both: Vector3<f64>,
}

impl Sources {
    /// Displacements at one target (m): `perfect` and `actual` are the machine without and with errors.
    pub(super) fn at(
        perfect: &Mechanism,
        actual: &Mechanism,
        point: [f64; 3],
        wrench: &Wrench,
    ) -> Result<Self, Cause> {
        let moved = |machine: &Mechanism, wrench: &Wrench| -> Result<Vector3<f64>, Cause> {
            let posture = machine.posture(&target(point))?;
            Ok(posture.deflected_by(wrench)?.displacement.linear() * 1e3)
        };
        Ok(Self {
            force: moved(perfect, wrench)?,
            errors: moved(actual, &Wrench::zero())?,
            both: moved(actual, wrench)?,
        })
    }

    /// The sum of both alone.
    pub(super) fn superposed(&self) -> Vector3<f64> {
        self.force + self.errors
    }

    /// Difference of the sum from both together, mm.
    pub(super) fn apart(&self) -> f64 {
        (self.superposed() - self.both).norm()
    }
}

/// Steps of the line; every fourth belongs to the eleven points of the means.
const STEPS: u32 = 40;

fn line(case: &Orthoglide) -> Result<Vec<(f64, Sources)>, Cause> {
    let perfect = Orthoglide::default().build()?;
    let actual = case.build()?;
    let wrench = cutting(0.0);
    (0..=STEPS)
        .into_par_iter()
        .map(|k| {
            let y = SMALL + (LARGE - SMALL) * f64::from(k) / f64::from(STEPS);
            let sources = Sources::at(&perfect, &actual, [SMALL, y, SMALL], &wrench)?;
            Ok((y * 1e3, sources))
        })
        .collect()
}

/// Curves (1) to (5) of these figures and of Figure 7.5.
type Curve = (&'static str, fn(&Sources) -> Vector3<f64>);
const CURVES: [Curve; 5] = [
    ("(1) target", |_| Vector3::zeros()),
    ("(2) cutting force", |s| s.force),
    ("(3) errors of the legs", |s| s.errors),
    ("(4) both", |s| s.both),
    ("(5) sum of (2) and (3)", |s| s.superposed()),
];

fn figure(case: &Orthoglide, name: &str) -> Result<Contents, Cause> {
    let points = line(case)?;
    let few: Vec<&Sources> = points.iter().step_by(4).map(|(_, s)| s).collect();
    let most =
        |value: &dyn Fn(&Sources) -> f64| few.iter().fold(0.0_f64, |m, s| larger(m, value(s)));
    let least = |value: &dyn Fn(&Sources) -> f64| -most(&|s| 1e3 - value(s)) + 1e3;
    #[allow(clippy::cast_precision_loss)] // eleven points
    let mean = |value: &dyn Fn(&Sources) -> f64| {
        few.iter().map(|s| value(s)).sum::<f64>() / few.len() as f64
    };
    let note =
        "eleven points of the line; the figure prints no digits, the HTML page draws its curves";
    let wrench = cutting(0.0);
    let (force, moment) = (wrench.force(), wrench.moment());
    let print = "forces 215, -10, -25 N on a tool of 100 mm along z (7.16)";
    let mut items = vec![
        Item::compared("text: cutting force |F|", "217", force.norm(), "N", print),
        Item::compared("text: moment M_x", "1", moment.x, "N m", print),
        Item::compared("text: moment M_y", "21.5", moment.y, "N m", print),
    ];
    let texts: [(&str, f64, &str); 7] = [
        (
            "largest difference of sum (5) and total (4)",
            most(&Sources::apart),
            note,
        ),
        (
            "mean difference of sum (5) and total (4)",
            mean(&Sources::apart),
            "eleven points; of Cases A and B the text calls one close and one not, naming both B: by these means B is the one that differs (erratum 16 of part 2)",
        ),
        (
            "smallest displacement by the force alone (2)",
            least(&|s| s.force.norm()),
            note,
        ),
        (
            "largest displacement by the force alone (2)",
            most(&|s| s.force.norm()),
            note,
        ),
        (
            "largest displacement by the errors alone (3)",
            most(&|s| s.errors.norm()),
            note,
        ),
        (
            "largest total displacement (4)",
            most(&|s| s.both.norm()),
            note,
        ),
        ("largest sum (5)", most(&|s| s.superposed().norm()), note),
    ];
    for (name, value, note) in texts {
        items.push(Item::unprinted(name, value, "mm", note));
    }
    let plots = [(0, "x"), (2, "z")]
        .into_iter()
        .map(|(axis, letter)| Plot {
            title: format!("Milling from Q2 to Q5, {name}: displacement along {letter}"),
            x_label: "y of the target, mm".into(),
            y_label: format!("displacement along {letter}, mm"),
            lines: CURVES
                .iter()
                .enumerate()
                .map(|(colour, (name, of))| PlotLine {
                    name: (*name).into(),
                    colour,
                    // Close to the fourth: dashes let both be seen.
                    dashed: colour == 4,
                    dots: false,
                    points: points.iter().map(|(y, s)| (*y, of(s)[axis])).collect(),
                })
                .collect(),
            marks: Vec::new(),
        })
        .collect();
    Ok(Contents { items, plots })
}

pub(crate) fn fig_6_6() -> Result<Contents, Cause> {
    figure(&Orthoglide::case_a(), "Case A (1 mm along each slider)")
}

pub(crate) fn fig_6_7() -> Result<Contents, Cause> {
    figure(&Orthoglide::case_b(), "Case B (1 degree about each slider)")
}
