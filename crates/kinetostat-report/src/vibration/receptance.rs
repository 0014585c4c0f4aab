//! Receptance over the frequency: magnitude over logarithms, phase below it.

use nalgebra::Complex;

use crate::chart::plot::{Look, Plot, PlotLine, stacked};

/// One curve of a receptance.
#[derive(Clone, Debug, PartialEq)]
pub struct ReceptanceCurve {
    /// Name in the legend, as `x by force along x`.
    pub name: String,
    /// Dashed, as for what is measured beside a model.
    pub dashed: bool,
    /// Frequencies, Hz, above 0.
    pub frequencies_hz: Vec<f64>,
    /// Displacement by force at each, m/N.
    pub receptance: Vec<Complex<f64>>,
}

/// Motion by force that is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DrawnMotion {
    /// Displacement by force.
    #[default]
    Receptance,
    /// Velocity by force.
    Mobility,
    /// Acceleration by force.
    Accelerance,
}

impl DrawnMotion {
    /// Axis label, order of the derivative of a displacement, and unit by that of SI.
    fn axis(self) -> (&'static str, i32, f64) {
        match self {
            Self::Receptance => ("receptance, \u{b5}m/N", 0, 1e6),
            Self::Mobility => ("mobility, mm/(s N)", 1, 1e3),
            Self::Accelerance => ("accelerance, m/(s\u{b2} N)", 2, 1.0),
        }
    }
}

/// The curves as a document.
pub(crate) fn draw(curves: &[ReceptanceCurve], motion: DrawnMotion, title: &str) -> String {
    let (y_label, order, unit) = motion.axis();
    let drawn = |hertz: f64, value: &Complex<f64>| {
        let turned = Complex::new(0.0, std::f64::consts::TAU * hertz).powi(order);
        value * turned * unit
    };
    let line =
        |number: usize, curve: &ReceptanceCurve, of: &dyn Fn(&Complex<f64>) -> f64| PlotLine {
            name: curve.name.clone(),
            colour: number,
            dashed: curve.dashed,
            points: curve
                .frequencies_hz
                .iter()
                .zip(&curve.receptance)
                .map(|(f, value)| (logarithm(*f), of(&drawn(*f, value))))
                .collect(),
        };
    let all = |of: &dyn Fn(&Complex<f64>) -> f64| -> Vec<PlotLine> {
        let numbered = curves.iter().enumerate();
        numbered.map(|(k, curve)| line(k, curve, of)).collect()
    };
    let magnitude = Plot {
        title: title.to_owned(),
        x_label: "frequency, Hz".into(),
        y_label: y_label.into(),
        lines: all(&|value| logarithm(value.norm())),
        marks: Vec::new(),
    };
    let nameless = |line: PlotLine| PlotLine {
        name: String::new(),
        ..line
    };
    let phase = Plot {
        title: "phase".into(),
        x_label: "frequency, Hz".into(),
        y_label: "phase, deg".into(),
        // A jump of a whole turn is no line.
        lines: all(&|value| value.arg().to_degrees())
            .into_iter()
            .map(|line| lifted(nameless(line)))
            .collect(),
        marks: Vec::new(),
    };
    let look = |y: bool| Look {
        decades: [true, y],
        ..Look::default()
    };
    stacked(&[(&magnitude, look(true)), (&phase, look(false))], "")
}

fn logarithm(value: f64) -> f64 {
    if value > 0.0 { value.log10() } else { f64::NAN }
}

fn lifted(mut line: PlotLine) -> PlotLine {
    let mut points = Vec::with_capacity(line.points.len());
    for (k, point) in line.points.iter().enumerate() {
        if k > 0 && (point.1 - line.points[k - 1].1).abs() > 270.0 {
            points.push((f64::NAN, f64::NAN));
        }
        points.push(*point);
    }
    line.points = points;
    line
}
