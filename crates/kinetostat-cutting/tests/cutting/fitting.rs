//! Coefficients from mean forces: forces summed up tooth by tooth here give them back, with honest intervals.

use std::f64::consts::{PI, TAU};

use kinetostat_cutting::{
    CoefficientFit, Contact, Correction, CutErrorKind, Engagement, Feed, Linear, Materials,
    MeanForce, MeasuredCut, Milling, RunOut, Series, Shape, Side, Tool, fit_coefficients,
};
use proptest::prelude::*;

use crate::noise::Noise;

const STEEL: ([f64; 3], [f64; 3]) = ([1700.0, 650.0, 300.0], [25.0, 35.0, 5.0]);

/// A cut as plain numbers: teeth, depth, arc.
#[derive(Clone, Copy, Debug)]
struct Plain {
    teeth: usize,
    depth: f64,
    entry: f64,
    exit: f64,
}

const SLOT: Plain = Plain {
    teeth: 2,
    depth: 3.0,
    entry: 0.0,
    exit: PI,
};
const UP: Plain = Plain {
    teeth: 4,
    depth: 5.0,
    entry: 0.0,
    exit: 1.2,
};
const DOWN: Plain = Plain {
    teeth: 3,
    depth: 4.0,
    entry: 2.0,
    exit: PI,
};

impl Plain {
    fn measured(self) -> MeasuredCut {
        let tool = Tool::new(Shape::Flat, 16.0, self.teeth).unwrap();
        let contacts = vec![Contact::side(0.0, self.depth, self.entry, self.exit)];
        MeasuredCut::new(&tool, &Engagement { contacts }).unwrap()
    }

    /// Mean force on the tool, summed over the arc of a tooth by Simpson's rule.
    fn summed(self, law: ([f64; 3], [f64; 3]), feed: f64) -> [f64; 3] {
        let steps = 2000;
        let step = (self.exit - self.entry) / f64::from(steps);
        let mut force = [0.0; 3];
        for i in 0..=steps {
            let phi = self.entry + step * f64::from(i);
            let weight = match i {
                0 => 1.0,
                _ if i == steps => 1.0,
                _ if i % 2 == 1 => 4.0,
                _ => 2.0,
            } * step
                / 3.0;
            let chip = feed * phi.sin();
            let [t, r, a] = [0, 1, 2].map(|k| (law.0[k] * chip + law.1[k]) * self.depth);
            // Against the way of the tooth, against the outward normal, towards the shank.
            force[0] += weight * (-t * phi.cos() - r * phi.sin());
            force[1] += weight * (t * phi.sin() - r * phi.cos());
            force[2] += weight * a;
        }
        force.map(|sum| sum * self.teeth as f64 / TAU)
    }

    fn series(
        self,
        law: ([f64; 3], [f64; 3]),
        feeds: &[f64],
        noise: &mut impl FnMut() -> f64,
    ) -> Series {
        let row = |feed: &f64| MeanForce {
            feed_mm_per_tooth: *feed,
            force_n: self.summed(law, *feed).map(|force| Some(force + noise())),
        };
        let rows = feeds.iter().map(row).collect();
        Series::new(self.measured(), rows).unwrap()
    }
}

fn truth(law: ([f64; 3], [f64; 3])) -> [f64; 6] {
    let ([a, b, c], [d, e, f]) = law;
    [a, b, c, d, e, f]
}

/// Largest error of a coefficient, as a share of it.
fn worst(fit: &CoefficientFit, law: ([f64; 3], [f64; 3])) -> f64 {
    let pairs = fit.coefficients.iter().zip(truth(law));
    let errors = pairs.map(|(c, t)| (c.value - t).abs() / t.abs());
    errors
        .reduce(|a, b| if b > a || b.is_nan() { b } else { a })
        .unwrap()
}

#[test]
fn exact_forces_give_the_coefficients() {
    let feeds = [0.04, 0.08, 0.12, 0.2];
    for cuts in [
        vec![SLOT],
        vec![UP],
        vec![DOWN],
        vec![SLOT, UP],
        vec![SLOT, UP, DOWN],
    ] {
        let series: Vec<Series> = cuts
            .iter()
            .map(|c| c.series(STEEL, &feeds, &mut || 0.0))
            .collect();
        let fit = fit_coefficients(&series).unwrap();
        let error = worst(&fit, STEEL);
        assert!(error < 1e-9, "{cuts:?}: {error:e}");
        for (coefficient, expected) in fit
            .coefficients
            .iter()
            .zip(["K_tc", "K_rc", "K_ac", "K_te", "K_re", "K_ae"])
        {
            assert_eq!(coefficient.symbol, expected);
            assert!(coefficient.half_width_95.unwrap() < 1e-6);
        }
        for axis in 0..3 {
            assert!(1.0 - fit.r_squared[axis].unwrap() < 1e-12);
        }
        assert_eq!(fit.residuals_n.len(), cuts.len());
        let left = fit.residuals_n.iter().flatten().flatten();
        assert!(left.clone().all(|r| r.unwrap().abs() < 1e-8));
        assert_eq!(left.count(), cuts.len() * feeds.len() * 3);
        let law = fit.law().unwrap();
        assert!(
            (law.cutting_n_per_mm2[1] - 650.0).abs() < 1e-6
                && (law.edge_n_per_mm[2] - 5.0).abs() < 1e-6
        );
    }
}

/// A slot 25 mm wide and 3 mm deep, two teeth, 6000 rev/min: means of one second of a dynamometer's records
/// (github.com/leekunhwee/ForceCalculation, General/Flat end milling, five CSV files of 10 001 samples; its own axes turned
/// into ours). The coefficients that its author found from them are printed in blog.csdn.net/2401_82386822/article/details/141181694.
#[test]
fn a_published_slot_test_gives_its_published_coefficients() {
    let text = "\
feed_mm_per_tooth,fx_n,fy_n,fz_n
0.025,-39.7970,63.0178,55.7214
0.050,-60.0528,107.1381,70.9095
0.075,-71.6049,137.6731,82.5741
0.100,-76.7469,171.2679,85.2269
0.125,-78.4868,210.7392,83.5039
";
    let tool = Tool::new(Shape::Flat, 25.0, 2).unwrap();
    let slot = Engagement::straight(12.5, 25.0, 3.0, Side::Left).unwrap();
    let cut = MeasuredCut::new(&tool, &slot).unwrap();
    let series = Series::read("slot.csv", text, cut).unwrap();
    let fit = fit_coefficients(&[series]).unwrap();
    let published = [958.8599, 250.8633, 146.3614, 15.7580, 19.4337, 18.2075];
    for (coefficient, printed) in fit.coefficients.iter().zip(published) {
        let error = (coefficient.value / printed - 1.0).abs();
        assert!(
            error < 1e-5,
            "{}: {}",
            coefficient.symbol,
            coefficient.value
        );
    }
    // The tangential force follows the line, the others bend: their intervals say so.
    let share = |i: usize| fit.coefficients[i].half_width_95.unwrap() / published[i];
    assert!(
        share(0) < 0.2 && share(2) > 0.5,
        "{} {}",
        share(0),
        share(2)
    );
    assert!(fit.r_squared[1].unwrap() > 0.99 && fit.r_squared[0].unwrap() < 0.95);
}

/// Forces of the integration along the edges: helix changes nothing, nor does run-out that lets no tooth miss its chip. At
/// the ends of a half turn chips are thin, and any run-out lets teeth miss them: the fit is off by percents then.
#[test]
fn forces_of_a_helical_cutter_with_run_out_give_their_law() {
    let materials = Materials::library();
    let law = materials.find("linear steel").unwrap();
    let law = law.for_milling(&Correction::default()).unwrap().law;
    let cases = [
        // Run-out, arc, largest error of a coefficient.
        (0.0, 0.0, 1.2, 1e-7),
        (0.0, 0.0, PI, 1e-7),
        (0.004, 0.6, 1.4, 1e-7),
        (0.004, 0.0, 1.2, 0.06),
    ];
    for (offset_mm, entry, exit, most) in cases {
        let run_out = RunOut {
            offset_mm,
            angle: 1.0,
        };
        let tool = Tool::new(Shape::Flat, 12.0, 3)
            .unwrap()
            .with_helix(0.6)
            .unwrap();
        let tool = tool.with_run_out(run_out).unwrap();
        let engagement = Engagement {
            contacts: vec![Contact::side(0.0, 2.0, entry, exit)],
        };
        let row = |feed: f64| {
            let feeds = Feed::level(feed).unwrap();
            let force = Milling::new(&tool, &law, &engagement, feeds).mean().force_n;
            MeanForce {
                feed_mm_per_tooth: feed,
                force_n: [force.x, force.y, force.z].map(Some),
            }
        };
        let rows = [0.05, 0.1, 0.15].map(row).to_vec();
        let series = Series::new(MeasuredCut::new(&tool, &engagement).unwrap(), rows).unwrap();
        let error = worst(&fit_coefficients(&[series]).unwrap(), STEEL);
        assert!(error < most, "{offset_mm} mm, {entry} to {exit}: {error:e}");
    }
}

/// Values of `shared/theory/cutting.md`, Reference values, first row: a plain summation over angles and slices.
#[test]
fn the_closed_form_agrees_with_the_reference_values() {
    let tool = Tool::new(Shape::Flat, 12.0, 4).unwrap();
    let tool = tool.with_helix(38_f64.to_radians()).unwrap();
    let down = Engagement::straight(6.0, 3.97, 1.58, Side::Right).unwrap();
    let law = Linear::new([796.0, 168.0, 222.0], [27.7, 30.8, 1.4]).unwrap();
    let force = MeasuredCut::new(&tool, &down)
        .unwrap()
        .mean_force_n(&law, 0.191);
    for (found, printed) in force.iter().zip([58.79, 131.25, 29.95]) {
        assert!(
            (found - printed).abs() < 0.01 + 1e-4 * printed,
            "{found} {printed}"
        );
    }
}

#[test]
fn two_feeds_alone_leave_nothing_to_judge_by() {
    let fit = fit_coefficients(&[SLOT.series(STEEL, &[0.05, 0.2], &mut || 0.0)]).unwrap();
    assert!(worst(&fit, STEEL) < 1e-9);
    assert!(
        fit.coefficients
            .iter()
            .all(|c| c.half_width_95.is_none() && c.standard_error.is_none())
    );
    assert!((fit.largest_chip_mm - 0.2).abs() < 1e-12);
    let fit = fit_coefficients(&[UP.series(STEEL, &[0.05, 0.2], &mut || 0.0)]).unwrap();
    assert!((fit.largest_chip_mm - 0.2 * 1.2_f64.sin()).abs() < 1e-12);
}

#[test]
fn intervals_hold_the_truth_in_about_95_of_100_trials() {
    let trials = 2000;
    let feeds = [0.05, 0.1, 0.15, 0.2];
    for cuts in [vec![SLOT], vec![DOWN], vec![SLOT, UP]] {
        let mut noise = Noise(7);
        let mut held = [0; 6];
        for _ in 0..trials {
            let series: Vec<Series> = cuts
                .iter()
                .map(|cut| cut.series(STEEL, &feeds, &mut || 8.0 * noise.normal()))
                .collect();
            let fit = fit_coefficients(&series).unwrap();
            for (i, (coefficient, true_value)) in
                fit.coefficients.iter().zip(truth(STEEL)).enumerate()
            {
                let width = coefficient.half_width_95.unwrap();
                held[i] += usize::from((coefficient.value - true_value).abs() <= width);
            }
        }
        for (i, count) in held.into_iter().enumerate() {
            // 1900 are expected, with a standard deviation of 10.
            assert!(
                (1860..=1940).contains(&count),
                "{cuts:?}: coefficient {i} in {count} of {trials}"
            );
        }
    }
}

/// Share of Student's distribution between `-t` and `t`, integrated in the angle `atan(x/sqrt(n))`: its density there is
/// the power `n - 1` of the cosine.
fn share_within(t: f64, freedom: usize) -> f64 {
    let within = |to: f64| {
        let steps = 4000;
        let step = to / f64::from(steps);
        let density = |i: i32| {
            (step * f64::from(i))
                .cos()
                .max(0.0)
                .powi(freedom as i32 - 1)
        };
        let inner: f64 = (1..steps)
            .map(|i| density(i) * if i % 2 == 1 { 4.0 } else { 2.0 })
            .sum();
        (density(0) + inner + density(steps)) * step / 3.0
    };
    within((t / (freedom as f64).sqrt()).atan()) / within(PI / 2.0)
}

#[test]
fn half_widths_are_those_of_students_distribution() {
    let mut noise = Noise(3);
    for freedom in (1..=60).chain([100, 500, 5000]) {
        // Two unknowns along the axis, four in the plane with two forces a row: rows - 2 and 2 rows - 4.
        let feeds: Vec<f64> = (0..freedom + 2).map(|i| 0.05 + 0.001 * i as f64).collect();
        let feeds: Vec<f64> = feeds
            .iter()
            .map(|feed| feed / feeds[freedom + 1] * 0.3)
            .collect();
        let fit = fit_coefficients(&[SLOT.series(STEEL, &feeds, &mut || noise.normal())]).unwrap();
        for (i, freedom) in [
            (0, 2 * freedom),
            (2, freedom),
            (4, 2 * freedom),
            (5, freedom),
        ] {
            let coefficient = fit.coefficients[i];
            let t = coefficient.half_width_95.unwrap() / coefficient.standard_error.unwrap();
            let share = share_within(t, freedom);
            assert!(
                (share - 0.95).abs() < 2e-7,
                "{freedom} degrees: {t} holds {share}"
            );
        }
    }
}

/// A straight line through points, by the formulas of any book of statistics.
#[test]
fn the_axial_part_of_a_slot_is_a_straight_line() {
    let mut noise = Noise(11);
    let feeds = [0.03, 0.07, 0.1, 0.16, 0.21];
    let series = SLOT.series(STEEL, &feeds, &mut || 3.0 * noise.normal());
    let fit = fit_coefficients(std::slice::from_ref(&series)).unwrap();
    // Of Fz = N a/pi K_ac c + N a/2 K_ae, with the forces found again from fit and residuals.
    let forces: Vec<f64> = feeds
        .iter()
        .zip(&fit.residuals_n[0])
        .map(|(feed, residual)| {
            let fitted =
                6.0 / PI * fit.coefficients[2].value * feed + 3.0 * fit.coefficients[5].value;
            fitted + residual[2].unwrap()
        })
        .collect();
    let n = 5.0;
    let (mean_c, mean_f) = (
        feeds.iter().sum::<f64>() / n,
        forces.iter().sum::<f64>() / n,
    );
    let s_cc: f64 = feeds.iter().map(|c| (c - mean_c).powi(2)).sum();
    let s_cf: f64 = feeds
        .iter()
        .zip(&forces)
        .map(|(c, f)| (c - mean_c) * (f - mean_f))
        .sum();
    let slope = s_cf / s_cc;
    let intercept = mean_f - slope * mean_c;
    let left: f64 = feeds
        .iter()
        .zip(&forces)
        .map(|(c, f)| (f - intercept - slope * c).powi(2))
        .sum();
    let all: f64 = forces.iter().map(|f| (f - mean_f).powi(2)).sum();
    let variance = left / 3.0;
    let (k_ac, k_ae) = (fit.coefficients[2], fit.coefficients[5]);
    assert!((k_ac.value / (slope * PI / 6.0) - 1.0).abs() < 1e-10);
    assert!((k_ae.value / (intercept / 3.0) - 1.0).abs() < 1e-10);
    assert!(
        (k_ac.standard_error.unwrap() / ((variance / s_cc).sqrt() * PI / 6.0) - 1.0).abs() < 1e-9
    );
    let of_intercept = (variance * (1.0 / n + mean_c * mean_c / s_cc)).sqrt() / 3.0;
    assert!((k_ae.standard_error.unwrap() / of_intercept - 1.0).abs() < 1e-9);
    assert!((fit.r_squared[2].unwrap() - (1.0 - left / all)).abs() < 1e-12);
}

#[test]
fn what_the_forces_do_not_determine_is_named() {
    let error_of = |text: &str, cut: Plain| {
        let series = Series::read("test.csv", text, cut.measured()).unwrap();
        let error = fit_coefficients(&[series]).unwrap_err();
        assert_eq!(error.kind, CutErrorKind::Measurement);
        error.quantity
    };
    let feeds = "0.1,50\n0.2,80\n0.3,115";
    // Of a slot, Fy has the tangential part alone and Fx the radial one.
    assert_eq!(
        error_of(&format!("feed_mm_per_tooth,fy_n\n{feeds}"), SLOT),
        "K_rc, K_re, K_ac, K_ae"
    );
    assert_eq!(
        error_of(&format!("feed_mm_per_tooth,fx_n\n{feeds}"), SLOT),
        "K_tc, K_te, K_ac, K_ae"
    );
    assert_eq!(
        error_of(&format!("feed_mm_per_tooth,fz_n\n{feeds}"), SLOT),
        "K_tc, K_rc, K_te, K_re"
    );
    // Of partial immersion, one force mixes both.
    assert_eq!(
        error_of(&format!("feed_mm_per_tooth,fx_n\n{feeds}"), UP),
        "K_tc, K_rc, K_te, K_re, K_ac, K_ae"
    );
    let text = "feed_mm_per_tooth,fx_n,fy_n\n0.1,50,60\n0.2,80,100";
    assert_eq!(error_of(text, UP), "K_ac, K_ae");
    assert!(fit_coefficients(&[]).is_err());
}

#[test]
fn one_force_in_each_of_two_immersions_is_enough() {
    let feeds = [0.05, 0.1, 0.2];
    let only = |cut: Plain, keep: [bool; 3]| {
        let row = |feed: &f64| {
            let force = cut.summed(STEEL, *feed);
            MeanForce {
                feed_mm_per_tooth: *feed,
                force_n: [0, 1, 2].map(|k| keep[k].then_some(force[k])),
            }
        };
        Series::new(cut.measured(), feeds.iter().map(row).collect()).unwrap()
    };
    let series = [
        only(UP, [true, false, true]),
        only(DOWN, [true, false, false]),
    ];
    let fit = fit_coefficients(&series).unwrap();
    assert!(worst(&fit, STEEL) < 1e-9);
    assert_eq!(fit.r_squared[1], None);
}

#[test]
fn csv_is_read_in_any_order_with_comments() {
    let text = "\u{feff}# slot, 16 mm\n\nfz_n, feed_mm_per_tooth ,fx_n,fy_n\r\n1,0.1,-2,3e1\n# again\n4,0.2,-5,6\n";
    let read = Series::read("slot.csv", text, SLOT.measured()).unwrap();
    let rows = [(0.1, [-2.0, 30.0, 1.0]), (0.2, [-5.0, 6.0, 4.0])];
    let rows = rows.map(|(feed_mm_per_tooth, force)| MeanForce {
        feed_mm_per_tooth,
        force_n: force.map(Some),
    });
    assert_eq!(read, Series::new(SLOT.measured(), rows.to_vec()).unwrap());
}

#[test]
fn semicolons_stand_for_commas() {
    let read = |text: &str| Series::read("slot.csv", text, SLOT.measured()).unwrap();
    let commas = "feed_mm_per_tooth,fx_n,fy_n\n0.1,-2,30\n0.2,-5,60\n";
    assert_eq!(read(commas), read(&commas.replace(',', ";")));
    let series = read(commas);
    assert_eq!(series.cut(), &SLOT.measured());
    assert_eq!(series.rows()[1].force_n, [Some(-5.0), Some(60.0), None]);
}

/// The interval of a line through points (Student's t on `s sqrt(1/n + (x - mean)^2 / S_xx)`): along z a slot has one such
/// line, alone.
#[test]
fn the_interval_of_the_force_is_that_of_a_straight_line() {
    let feeds = [0.05, 0.08, 0.12, 0.15, 0.2];
    let forces = [21.0, 29.5, 40.2, 47.0, 63.1];
    let row = |(feed, force): (&f64, &f64)| MeanForce {
        feed_mm_per_tooth: *feed,
        force_n: [Some(-10.0 * feed), Some(40.0 * feed), Some(*force)],
    };
    let rows = feeds.iter().zip(&forces).map(row).collect();
    let fit = fit_coefficients(&[Series::new(SLOT.measured(), rows).unwrap()]).unwrap();
    let n = feeds.len() as f64;
    let mean = feeds.iter().sum::<f64>() / n;
    let mean_force = forces.iter().sum::<f64>() / n;
    let s_xx: f64 = feeds.iter().map(|x| (x - mean).powi(2)).sum();
    let s_xy: f64 = feeds
        .iter()
        .zip(&forces)
        .map(|(x, y)| (x - mean) * (y - mean_force))
        .sum();
    let slope = s_xy / s_xx;
    let left: f64 = feeds
        .iter()
        .zip(&forces)
        .map(|(x, y)| (y - mean_force - slope * (x - mean)).powi(2))
        .sum();
    let s = (left / (n - 2.0)).sqrt();
    for feed in [0.0, 0.05, 0.1, 0.3] {
        // 97.5 % of Student's distribution with 3 degrees of freedom.
        let expected = 3.182_446 * s * (1.0 / n + (feed - mean).powi(2) / s_xx).sqrt();
        let found = fit.force_half_width_95(&SLOT.measured(), feed)[2].unwrap();
        assert!(
            (found - expected).abs() < 1e-6 * expected,
            "{feed}: {found}"
        );
    }
}

#[test]
fn faults_of_a_file_name_its_line() {
    let header = "feed_mm_per_tooth,fx_n,fy_n,fz_n";
    let cases = [
        (format!("{header}\n0.1,1,2,3\n-0.2,1,2,3\n"), 3, "-0.2 mm"),
        (
            format!("{header}\n0.1,1,2,3\n0,1,2,3\n"),
            3,
            "0.000001 to 10 mm",
        ),
        (
            format!("{header}\n0.1,1,2,3\n#\n\nNaN,1,2,3\n"),
            5,
            "NaN mm",
        ),
        (format!("{header}\n0.1,1,2,3\n0.2,inf,2,3\n"), 3, "inf N"),
        (format!("{header}\n0.1,1,2,3\n0.2,1,two,3\n"), 3, "`two`"),
        (format!("{header}\n0.1,1,2,3\n0.2,1,,3\n"), 3, "a number"),
        (
            format!("{header}\n0.1,1,2,3\n0.2,1,2\n"),
            3,
            "3 cells under 4 columns",
        ),
        (
            format!("{header}\n0.1,1,2,3\n0.1,1,2,4\n"),
            3,
            "0.1 mm in all 2 rows",
        ),
        (format!("{header}\n0.1,1,2,3\n"), 2, "two different feeds"),
        (format!("{header}\n"), 1, "no row"),
        (String::new(), 1, "no column `feed_mm_per_tooth`"),
        ("0.1,1,2,3\n0.2,1,2,3\n".to_owned(), 1, "column `0.1`"),
        ("feed,fx_n,fy_n,fz_n\n".to_owned(), 1, "column `feed`"),
        (
            "feed_mm_per_tooth,fx_n,fx_n\n".to_owned(),
            1,
            "column `fx_n` twice",
        ),
        (
            "feed_mm_per_tooth\n0.1\n0.2\n".to_owned(),
            1,
            "no column of a force",
        ),
        (
            "feed_mm_per_tooth|fx_n\n".to_owned(),
            1,
            "commas or semicolons between them",
        ),
        (
            "feed;fx_n;fy_n;fz_n\n".to_owned(),
            1,
            "did you mean `feed_mm_per_tooth`?",
        ),
        (
            "feed_mm_per_tooth,Fx,fy_n,fz_n\n".to_owned(),
            1,
            "did you mean `fx_n`?",
        ),
        (
            format!("{header}\n0.1,1,2,3\n8.5,1,2,3\n"),
            3,
            "half the diameter",
        ),
    ];
    for (text, line, expected) in cases {
        let error = Series::read("slot.csv", &text, SLOT.measured()).unwrap_err();
        assert_eq!(error.file.as_deref(), Some("slot.csv"));
        assert_eq!(error.line, Some(line), "{text:?}: {error}");
        assert!(error.to_string().contains(expected), "{text:?}: {error}");
    }
    let many = format!("{header}\n{}", "0.1,1,2,3\n".repeat(100_001));
    let error = Series::read("slot.csv", &many, SLOT.measured()).unwrap_err();
    assert_eq!(error.line, Some(100_002));
}

#[test]
fn cuts_without_a_closed_form_are_refused() {
    let flat = Tool::new(Shape::Flat, 16.0, 2).unwrap();
    let ball = Tool::new(Shape::Ball, 16.0, 2).unwrap();
    let side = |entry: f64, exit: f64| Engagement {
        contacts: vec![Contact::side(0.0, 2.0, entry, exit)],
    };
    assert!(MeasuredCut::new(&flat, &side(0.0, PI)).is_ok());
    let two = Engagement {
        contacts: [side(0.0, 1.0).contacts, side(2.0, 3.0).contacts].concat(),
    };
    let refused = [
        (&ball, side(0.0, PI)),
        (&flat, side(1.0, 4.0)),
        (&flat, side(-0.5, 1.0)),
        (&flat, side(1.0, 1.0)),
        (&flat, side(f64::NAN, 1.0)),
        (&flat, Engagement::plunge(8.0)),
        (&flat, Engagement::air()),
        (&flat, two),
    ];
    for (tool, engagement) in refused {
        let error = MeasuredCut::new(tool, &engagement).unwrap_err();
        assert_eq!(error.kind, CutErrorKind::Measurement, "{engagement:?}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn any_law_in_any_cut_is_found_again(
        cutting in prop::array::uniform3(50.0..3000.0_f64),
        edge in prop::array::uniform3(1.0..80.0_f64),
        teeth in 1_usize..9,
        depth in 0.2..20.0_f64,
        entry in 0.0..2.5_f64,
        arc in 0.3..3.0_f64,
        least in 0.01..0.1_f64,
    ) {
        let cut = Plain { teeth, depth, entry, exit: (entry + arc).min(PI) };
        let feeds = [least, 2.0 * least, 3.0 * least];
        let fit = fit_coefficients(&[cut.series((cutting, edge), &feeds, &mut || 0.0)]).unwrap();
        let error = worst(&fit, (cutting, edge));
        prop_assert!(error < 1e-6, "{error:e}");
    }

    #[test]
    fn no_text_makes_it_panic(text in "\\PC{0,120}", rows in "[-0-9eE.,\\n#\"na]{0,80}") {
        let _ = Series::read("slot.csv", &text, SLOT.measured());
        let _ = Series::read("slot.csv", &format!("feed_mm_per_tooth,fx_n\n{rows}"), SLOT.measured());
    }
}
