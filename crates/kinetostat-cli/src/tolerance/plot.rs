//! A histogram of one result, with the linear one above it.

use std::f64::consts::PI;

use kinetostat::number::larger;
use kinetostat_report::{Plot, PlotLine};

/// Largest height of a linear density in the drawing, in heights of the histogram.
const NEEDLE: f64 = 5.0;

/// Densities over the values: that of the draws in steps, and a normal one of the linear propagation.
pub(crate) fn histogram(
    title: String,
    label: &str,
    values: &[f64],
    [nominal, deviation]: [f64; 2],
) -> Plot {
    let mut known: Vec<f64> = values.iter().copied().filter(|x| x.is_finite()).collect();
    known.sort_unstable_by(f64::total_cmp);
    let (Some(low), Some(high)) = (known.first().copied(), known.last().copied()) else {
        return Plot {
            title,
            ..Plot::default()
        };
    };
    // The number of bars grows with the cube root of the draws, from ten to 80.
    let bars = ((2.0 * (known.len() as f64).cbrt()) as usize).clamp(10, 80);
    let width = (high - low) / bars as f64;
    let mut lines = Vec::new();
    let mut highest = 0.0;
    if width > 0.0 {
        let mut counts = vec![0.0; bars];
        for x in &known {
            counts[(((x - low) / width) as usize).min(bars - 1)] += 1.0;
        }
        let mut steps = vec![(low, 0.0)];
        for (k, count) in counts.iter().enumerate() {
            let density = count / (known.len() as f64 * width);
            highest = larger(highest, density);
            let left = low + width * k as f64;
            steps.extend([(left, density), (left + width, density)]);
        }
        steps.push((high, 0.0));
        lines.push(PlotLine::solid(
            format!("{} machines", known.len()),
            0,
            steps,
        ));
    }
    let peak = 1.0 / (deviation * (2.0 * PI).sqrt());
    // A linear scatter far below that of the machines would be a needle that hides them.
    if deviation > 0.0 && (highest == 0.0 || peak < NEEDLE * highest) {
        let at = |k: i32| {
            let z = f64::from(k) / 20.0;
            (nominal + z * deviation, peak * (-0.5 * z * z).exp())
        };
        lines.push(PlotLine::dashed(
            "linear, normal",
            1,
            (-80..=80).map(at).collect(),
        ));
    }
    Plot {
        title,
        x_label: label.to_owned(),
        y_label: "density".to_owned(),
        lines,
        marks: Vec::new(),
    }
}
