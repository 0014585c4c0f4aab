//! Figures 7.7 and 7.8: a groove milled in a circle, compensated [R 7.5].

use kinetostat_report::{Plot, PlotLine};
use nalgebra::Vector3;
use rayon::prelude::*;

use crate::orthoglide::circle::{At, Circle, READINGS, Reading};
use crate::orthoglide::machine::{POINTS, cutting};
use crate::{Cause, Contents, Item};
use kinetostat::number::{larger, smaller};

/// Remark on all of chapter 7.
const FRAME: &str = "The report gives neither the stiffness of the drives nor the places of the circles (they are in its figures only); its numbers are good to ±30 %.";

/// Text of a number of a circle under every reading.
fn readings(values: &[f64], unit: &str) -> String {
    let list: Vec<String> = READINGS
        .iter()
        .zip(values)
        .map(|(reading, value)| format!("{}: {value:.3}", reading.name))
        .collect();
    format!("{FRAME} Tried, in {unit}: {}", list.join("; "))
}

/// The circle at one point of the workspace under every reading.
struct Location {
    name: &'static str,
    point: [f64; 3],
    circles: Vec<Circle>,
}

impl Location {
    fn new(index: usize) -> Result<Self, Cause> {
        let (name, point) = POINTS[index];
        let circles = READINGS
            .par_iter()
            .map(|reading| reading.circle(point))
            .collect::<Result<Vec<Circle>, Cause>>()?;
        Ok(Self {
            name,
            point,
            circles,
        })
    }

    /// A printed number beside the one of reading A.
    fn item(&self, what: &str, printed: &str, unit: &str, value: fn(&Circle) -> f64) -> Item {
        let values: Vec<f64> = self.circles.iter().map(value).collect();
        let first = values.first().copied().unwrap_or(f64::NAN);
        let note = format!("reading A. {}", readings(&values, unit));
        Item::compared(
            format!("{}: {what}", self.name),
            printed,
            first,
            unit,
            &note,
        )
    }

    /// The circle under reading A.
    fn main(&self) -> Result<&Circle, Cause> {
        let missing = || Cause::Missing(format!("the circle at {}", self.name));
        self.circles.first().ok_or_else(missing)
    }
}

/// The load of every circle, as the text gives it.
pub(super) fn load() -> Vec<Item> {
    let wrench = cutting(0.0);
    vec![
        Item::compared(
            "text: cutting force |F|",
            "217",
            wrench.force().norm(),
            "N",
            "the same at every angle, which takes the sign of (7.17) in erratum 12 of part 2: F_x = F_r cos φ - F_t sin φ",
        ),
        Item::compared(
            "caption of 7.8: moment M_x at φ = 0",
            "1",
            wrench.moment().x,
            "N m",
            "(7.16), tool of 100 mm along +z",
        ),
        Item::compared(
            "caption of 7.8: moment M_y at φ = 0",
            "21.5",
            wrench.moment().y,
            "N m",
            "(7.16), tool of 100 mm along +z",
        ),
    ]
}

/// Path to be drawn: its name and its place from the centre.
pub(super) type DrawnPath = (&'static str, fn(&At) -> Vector3<f64>);

/// Paths of a circle in the plane, mm, drawn to about the same scale along x and y.
pub(super) fn plan(title: String, circle: &Circle, paths: &[DrawnPath]) -> Plot {
    let path = |(name, of): &DrawnPath| {
        let points = circle.points.iter();
        (*name, points.map(|p| (of(p).x, of(p).y)).collect())
    };
    closed_paths(title, paths.iter().map(path).collect())
}

/// Named paths about the centre of a circle, mm, drawn to about the same scale along x and y.
pub(super) fn closed_paths(title: String, paths: Vec<(&str, Vec<(f64, f64)>)>) -> Plot {
    let mut lines: Vec<PlotLine> = paths
        .into_iter()
        .enumerate()
        .map(|(colour, (name, points))| PlotLine::solid(name, colour, points))
        .collect();
    let all = || lines.iter().flat_map(|l| l.points.iter());
    let span = |of: fn(&(f64, f64)) -> f64| {
        let low = all().map(of).fold(0.0, smaller);
        let high = all().map(of).fold(0.0, larger);
        (0.5 * (low + high), 0.5 * (high - low))
    };
    let (x, y) = (span(|p| p.0), span(|p| p.1));
    // The plot's frame is about 1.9 times as wide as it is high; centre lines widen its span.
    let half = (x.1 / 1.9).max(y.1);
    let centre_line = |from, to| PlotLine {
        colour: 5,
        dashed: true,
        points: vec![from, to],
        ..PlotLine::default()
    };
    let (wide, high) = (1.9 * half, half);
    lines.insert(0, centre_line((x.0 - wide, 0.0), (x.0 + wide, 0.0)));
    lines.insert(1, centre_line((0.0, y.0 - high), (0.0, y.0 + high)));
    Plot {
        title,
        x_label: "x from the centre of the circle, mm".into(),
        y_label: "y from the centre, mm".into(),
        lines,
        marks: Vec::new(),
    }
}

/// Three components over the angle.
fn over_angle(
    title: String,
    y_label: &str,
    names: [&str; 3],
    circle: &Circle,
    of: fn(&At) -> Vector3<f64>,
) -> Plot {
    let lines = names
        .iter()
        .enumerate()
        .map(|(k, name)| {
            PlotLine::solid(
                *name,
                k,
                circle
                    .points
                    .iter()
                    .map(|p| (p.angle.to_degrees(), of(p)[k]))
                    .collect(),
            )
        })
        .collect();
    angle_plot(title, y_label, lines)
}

fn angle_plot(title: String, y_label: &str, lines: Vec<PlotLine>) -> Plot {
    Plot {
        title,
        x_label: "angle φ along the circle, degrees".into(),
        y_label: y_label.into(),
        lines,
        marks: Vec::new(),
    }
}

/// Residual error and cost of compensation at a location.
fn compensated(location: &Location, reading: &Reading) -> Result<Vec<Item>, Cause> {
    let (name, circle) = (location.name, location.main()?);
    Ok(vec![
        Item::unprinted(
            format!("{name}: largest distance left with compensation"),
            circle.most(|p| p.left.0),
            "mm",
            "the compensated machine, loaded again; the text: reduced near to zero",
        ),
        Item::unprinted(
            format!("{name}: largest rotation left with compensation"),
            circle.most(|p| p.left.1).to_degrees(),
            "deg",
            "three drives correct positions only (erratum 8 of part 2)",
        ),
        Item::unprinted(
            format!("{name}: steps of (7.13), α = 1, to 1e-9 mm"),
            f64::from(reading.steps(location.point)?),
            "",
            "the report's own iteration, the largest of four angles",
        ),
        Item::unprinted(
            format!("{name}: largest change of one actuator"),
            circle.one_command(),
            "mm",
            "the text's number fits the norm of the three better",
        ),
    ])
}

pub(crate) fn fig_7_7() -> Result<Contents, Cause> {
    let location = Location::new(1)?;
    let circle = location.main()?;
    let mut items = load();
    items.push(location.item(
        "compliance errors without compensation can exceed",
        "0.8",
        "mm",
        Circle::compliance,
    ));
    items.push(location.item(
        "change of the actuators, norm of the three, up to",
        "1.7",
        "mm",
        Circle::commands,
    ));
    items.push(location.item("force of an actuator up to", "300", "N", Circle::force));
    items.extend(compensated(&location, &READINGS[0])?);
    let title = |what: &str| format!("Circle of 50 mm about Q1: {what}");
    let actuators = ["actuator x", "actuator y", "actuator z"];
    let axes = ["along x", "along y", "along z"];
    let paths: [DrawnPath; 3] = [
        ("(1) target", |p| p.desired),
        ("(4) not compensated, 5 times", |p| {
            p.desired + 5.0 * p.sources.both
        }),
        ("(5) adjusted, 5 times", |p| p.desired + 5.0 * p.correction),
    ];
    let plots = vec![
        plan(title("path, deviations drawn 5 times"), circle, &paths),
        over_angle(
            title("change of the actuators"),
            "change of the command, mm",
            actuators,
            circle,
            |p| p.commands,
        ),
        over_angle(
            title("forces in the actuators"),
            "force, N",
            actuators,
            circle,
            |p| p.forces,
        ),
        over_angle(
            title("compliance errors (cutting force alone)"),
            "displacement, mm",
            axes,
            circle,
            |p| p.sources.force,
        ),
        over_angle(
            title("assembling errors (errors of the legs alone)"),
            "displacement, mm",
            axes,
            circle,
            |p| p.sources.errors,
        ),
        over_angle(
            title("errors that are compensated (both)"),
            "displacement, mm",
            axes,
            circle,
            |p| p.sources.both,
        ),
    ];
    Ok(Contents { items, plots })
}

pub(crate) fn fig_7_8() -> Result<Contents, Cause> {
    let locations = (0..POINTS.len())
        .into_par_iter()
        .map(Location::new)
        .collect::<Result<Vec<Location>, Cause>>()?;
    let mut items = load();
    let (best, worst) = (&locations[0], &locations[3]);
    items.push(worst.item(
        "compliance errors without compensation can exceed",
        "1.2",
        "mm",
        Circle::compliance,
    ));
    items.push(best.item(
        "deflection by the cutting force",
        "0.35",
        "mm",
        Circle::compliance,
    ));
    items.push(worst.item(
        "deflection by the cutting force",
        "1.25",
        "mm",
        Circle::compliance,
    ));
    items.push(best.item(
        "change of the actuators, norm of the three, up to",
        "0.6",
        "mm",
        Circle::commands,
    ));
    items.push(worst.item(
        "change of the actuators, norm of the three, up to",
        "1.9",
        "mm",
        Circle::commands,
    ));
    for location in &locations {
        let circle = location.main()?;
        let note = "reading A";
        let name = location.name;
        items.push(Item::unprinted(
            format!("{name}: largest compliance error"),
            circle.compliance(),
            "mm",
            note,
        ));
        items.push(Item::unprinted(
            format!("{name}: largest change of the actuators, norm"),
            circle.commands(),
            "mm",
            note,
        ));
        items.push(Item::unprinted(
            format!("{name}: largest force of an actuator"),
            circle.force(),
            "N",
            note,
        ));
    }
    for location in [best, worst] {
        items.extend(compensated(location, &READINGS[0])?);
    }
    let plots = plots_7_8(&locations)?;
    Ok(Contents { items, plots })
}

/// Plots over the angle: errors, changes and forces of all circles, and the actuators of the best and the worst.
fn plots_7_8(locations: &[Location]) -> Result<Vec<Plot>, Cause> {
    let compared = |title: &str, y_label: &str, of: fn(&At) -> f64| -> Result<Plot, Cause> {
        let lines = locations
            .iter()
            .enumerate()
            .map(|(colour, location)| {
                let circle = location.main()?;
                Ok(PlotLine::solid(
                    location.name,
                    colour,
                    circle
                        .points
                        .iter()
                        .map(|p| (p.angle.to_degrees(), of(p)))
                        .collect(),
                ))
            })
            .collect::<Result<Vec<PlotLine>, Cause>>()?;
        Ok(angle_plot(title.to_owned(), y_label, lines))
    };
    let mut plots = vec![
        compared(
            "Circles of 50 mm: compliance error without compensation",
            "displacement by the cutting force, mm",
            |p| p.sources.force.norm(),
        )?,
        compared(
            "Circles of 50 mm: change of the actuators",
            "norm of the three changes, mm",
            |p| p.commands.norm(),
        )?,
        compared(
            "Circles of 50 mm: largest force of an actuator",
            "force, N",
            |p| p.forces.amax(),
        )?,
    ];
    for location in [&locations[0], &locations[3]] {
        plots.push(over_angle(
            format!(
                "Circle of 50 mm about {}: change of the actuators",
                location.name
            ),
            "change of the command, mm",
            ["actuator x", "actuator y", "actuator z"],
            location.main()?,
            |p| p.commands,
        ));
    }
    Ok(plots)
}
