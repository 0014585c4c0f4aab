//! Equations 2.2 and 2.3: the force of a chip by its thickness, by Kienzle's law and by the rational one.

use kinetostat_cutting::{ForceLaw, Kienzle, Rational};
use kinetostat_report::{Plot, PlotLine, PlotMark};
use nalgebra::{Matrix3, Vector3};

use crate::chapter_2::library::kienzle;
use crate::chapter_2::materials::TABLE_2_2;
use crate::{Cause, Contents, Item};

/// Thickest chip that is drawn, mm: that of Table 2.3.
const THICKEST: f64 = 1.0;
/// Thinnest chip to which the coefficients of equation 2.3 are fitted, mm.
const THINNEST: f64 = 0.02;
/// Material of the fit.
const FITTED: &str = "AlMg4.5Mn";

/// Chips from a thin one to the thickest, mm, evenly spaced by their ratio.
fn chips() -> impl Iterator<Item = f64> {
    (0..=100).map(|k| THICKEST * (THINNEST / THICKEST).powf(1.0 - f64::from(k) / 100.0))
}

pub(crate) fn eq_2_2() -> Result<Contents, Cause> {
    let mut items = Vec::new();
    let plot = |title: &str, y_label: &str| Plot {
        title: title.into(),
        x_label: "chip thickness h, mm".into(),
        y_label: y_label.into(),
        ..Plot::default()
    };
    let mut specific = plot("Equation 2.2: specific cutting force", "k_c, N/mm^2");
    let mut force = plot(
        "Equations 2.1 and 2.2: force per width of the chip, all factors 1",
        "F/b = h k_c, N/mm",
    );
    for (colour, (printed_name, name, k, m)) in TABLE_2_2.into_iter().enumerate() {
        let law = kienzle(name)?;
        let number = |text: &str| {
            let missing = |_| Cause::Missing(format!("the number '{text}' of Table 2.2"));
            text.parse::<f64>().map_err(missing)
        };
        let (k, m) = (number(k)?, number(m)?);
        for h in [0.05_f64, 0.1, 0.5] {
            items.push(Item::formula(
                format!("{printed_name}: k_c at h = {h} mm"),
                "k_c1.1/h^(m_c)",
                k / h.powf(m),
                law.specific_n_per_mm2(h),
                "N/mm^2",
                "",
            ));
        }
        let line = |of: &dyn Fn(f64) -> f64| {
            PlotLine::solid(printed_name, colour, chips().map(|h| (h, of(h))).collect())
        };
        specific.lines.push(line(&|h| law.specific_n_per_mm2(h)));
        force.lines.push(line(&|h| h * law.specific_n_per_mm2(h)));
    }
    Ok(Contents {
        items,
        plots: vec![specific, force],
    })
}

const NO_COEFFICIENTS: &str = "The report prints no coefficients: these are fitted to equation 2.2 for Al Mg 4.5 Mn with chips of 0.02 to 1 mm. It calls the law fractal; it is a rational expression.";

/// `a_1`, `a_2` and `a_3` by least squares of the relative differences to a law, each multiplied by the denominator, which
/// makes the problem linear: `a_1 h/f + a_2 h^2/f - a_3 h = 1`.
fn fitted(law: &Kienzle) -> Result<[f64; 3], Cause> {
    let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
    for h in chips() {
        let f = law.edge_force(h).tangential;
        let row = Vector3::new(h / f, h * h / f, -h);
        normal += row * row.transpose();
        right += row;
    }
    let solution = normal.lu().solve(&right);
    let found = solution.ok_or_else(|| Cause::Missing("a fit of equation 2.3".into()))?;
    Ok(found.into())
}

pub(crate) fn eq_2_3() -> Result<Contents, Cause> {
    let kienzle = kienzle(FITTED)?;
    let [a_1, a_2, a_3] = fitted(&kienzle)?;
    let law = Rational::new([a_1, 0.0, 0.0], [a_2, 0.0, 0.0], [a_3, 0.0, 0.0])?;
    let unprinted =
        |name: &str, value, unit: &str| Item::unprinted(name, value, unit, NO_COEFFICIENTS);
    let mut items = vec![
        unprinted("a_1, slope for thin chips, per width", a_1, "N/mm^2"),
        unprinted("a_2, per width", a_2, "N/mm^3"),
        unprinted("a_3", a_3, "1/mm"),
        unprinted(
            "a_2/a_3, slope for thick chips, per width",
            a_2 / a_3,
            "N/mm^2",
        ),
    ];
    for h in [0.05, 0.2, 1.0] {
        items.push(Item::formula(
            format!("F/b at h = {h} mm, with these coefficients"),
            "(a_1 h + a_2 h^2)/(1 + a_3 h)",
            (a_1 * h + a_2 * h * h) / (1.0 + a_3 * h),
            law.edge_force(h).tangential,
            "N/mm",
            "The form of the law agrees; nothing can be said of numbers.",
        ));
    }
    let apart = chips()
        .map(|h| {
            100.0 * (law.edge_force(h).tangential / kienzle.edge_force(h).tangential - 1.0).abs()
        })
        .fold(0.0, kinetostat::number::larger);
    items.push(Item::unprinted(
        "largest difference of equations 2.3 and 2.2, chips of 0.02 to 1 mm",
        apart,
        "%",
        "What three coefficients can follow of a power of the thickness.",
    ));
    let line = |name: &str, colour, law: &dyn ForceLaw| {
        PlotLine::solid(
            name,
            colour,
            chips().map(|h| (h, law.edge_force(h).tangential)).collect(),
        )
    };
    let plot = Plot {
        title: "Equation 2.3 beside equation 2.2, Al Mg 4.5 Mn".into(),
        x_label: "chip thickness h, mm".into(),
        y_label: "force per width F/b, N/mm".into(),
        lines: vec![
            line("2.2: h k_c", 0, &kienzle),
            line("2.3, fitted to it", 1, &law),
        ],
        marks: vec![PlotMark {
            at: (0.2, kienzle.edge_force(0.2).tangential),
            name: "h = 0.2 mm".into(),
            detail: "The thinner chip of Table 2.3".into(),
        }],
    };
    Ok(Contents {
        items,
        plots: vec![plot],
    })
}
