//! Tables 6.1 and 6.2: legs with errors, assembled without a load [R 6.5.1].

use kinetostat::number::{larger, largest_size};
use kinetostat::{
    Mechanism, MechanismEquilibrium, MotionKind, Posture, Wrench, machine::LinearAssembly,
    model::Role,
};

use crate::orthoglide::machine::{Orthoglide, POINTS, inclination, target};
use crate::{Cause, Contents, Item, is_rounding};

/// Row of the tables, in mm, degrees and N m.
#[derive(Clone, Copy, Default)]
struct Row {
    shift: [f64; 3],
    turn: [f64; 3],
    moment: f64,
    joint: f64,
    spring_shift: f64,
    spring_turn: f64,
    spring_force: f64,
    spring_torque: f64,
}

/// Largest spring deflections and torques over the legs; torques by each leg's own stiffness.
fn springs(row: &mut Row, posture: &Posture, deflections: &[Vec<f64>]) {
    for ((limb, joints), deflections) in posture
        .mechanism()
        .limbs()
        .iter()
        .zip(posture.limbs())
        .zip(deflections)
    {
        let chain = &limb.nominal;
        let all = chain.indices_of(Role::Spring);
        let of = |index: usize| {
            all.iter()
                .position(|&i| i == index)
                .map_or(0.0, |k| deflections[k])
        };
        for block in chain.springs() {
            let stiffness = block.stiffness_at(&joints.coordinates);
            for i in 0..block.len() {
                let deflection = of(block.first + i);
                let torque: f64 = (0..block.len())
                    .map(|j| stiffness[(i, j)] * of(block.first + j))
                    .sum();
                let (size, load, unit) = match chain.coordinates()[block.first + i].kind {
                    MotionKind::Prismatic => (&mut row.spring_shift, &mut row.spring_force, 1e3),
                    MotionKind::Revolute => (
                        &mut row.spring_turn,
                        &mut row.spring_torque,
                        1_f64.to_degrees(),
                    ),
                };
                *size = larger(*size, deflection.abs() * unit);
                *load = larger(*load, torque.abs());
            }
        }
    }
}

/// Row to first order [R 6.15-6.20].
fn linear(posture: &Posture, own: &Posture) -> Result<Row, Cause> {
    let LinearAssembly {
        shift,
        wrenches,
        passive,
        springs: deflections,
        ..
    } = posture.linear_assembly(&posture.assembly_errors())?;
    let mut row = Row {
        shift: (shift.linear() * 1e3).into(),
        turn: shift.angular().map(f64::to_degrees).into(),
        moment: largest_size(wrenches.iter().flat_map(|w| [w.0[3], w.0[4], w.0[5]])),
        joint: largest_size(passive.iter().flatten().copied()).to_degrees(),
        ..Row::default()
    };
    springs(&mut row, own, &deflections);
    Ok(row)
}

/// Exactly: the equilibrium of the legs as they are.
fn exact(posture: &Posture) -> Result<(Row, MechanismEquilibrium), Cause> {
    let e = posture.deflected_by(&Wrench::zero())?;
    let legs = e
        .limbs
        .iter()
        .zip(posture.limbs())
        .zip(posture.mechanism().limbs());
    let joint = largest_size(legs.flat_map(|((now, before), limb)| {
        let moved = |i: usize| now.coordinates[i] - before.coordinates[i];
        limb.nominal
            .indices_of(Role::Passive)
            .into_iter()
            .map(moved)
            .collect::<Vec<_>>()
    }));
    let moments = e.limbs.iter().flat_map(|l| {
        let m = l.wrench.moment();
        [m.x, m.y, m.z]
    });
    let row = Row {
        shift: (e.displacement.linear() * 1e3).into(),
        turn: e.displacement.angular().map(f64::to_degrees).into(),
        moment: largest_size(moments),
        joint: joint.to_degrees(),
        ..Row::default()
    };
    Ok((row, e))
}

/// Printed shifts (mm) and largest joint angle (deg) of Table 6.1.
const CASE_A: [([&str; 3], &str); 5] = [
    (["1", "1", "1"], "0.18"),
    (["0.50", "0.50", "0.50"], "0.14"),
    (["2.02", "2.02", "2.02"], "0.42"),
    (["0.73", "0.73", "0.27"], "0.20"),
    (["0.56", "0.56", "1.28"], "0.26"),
];

pub(crate) fn table_6_1() -> Result<Contents, Cause> {
    let machine = Orthoglide::case_a().build()?;
    let mut items = Vec::new();
    let mut rows = Vec::new();
    for ((name, point), (shift, joint)) in POINTS.iter().zip(CASE_A) {
        let posture = machine.posture(&target(*point))?;
        let first = linear(&posture, &posture)?;
        let (second, _) = exact(&posture)?;
        let note = |exact: f64, unit: &str| {
            format!("to first order, as (6.15)-(6.20); the exact equilibrium has {exact:.6} {unit}")
        };
        for i in 0..3 {
            items.push(Item::compared(
                format!("{name}: shift δ{}", i + 1),
                shift[i],
                first.shift[i],
                "mm",
                &note(second.shift[i], "mm"),
            ));
        }
        items.push(Item::compared(
            format!("{name}: largest change of a passive joint, Δq max"),
            joint,
            first.joint,
            "deg",
            &note(second.joint, "deg"),
        ));
        rows.push((first, second));
    }
    let over = |value: fn(&Row) -> f64| largest_size(rows.iter().map(|(first, _)| value(first)));
    for (name, value, unit) in [
        ("spring translation θp", over(|r| r.spring_shift), "mm"),
        ("spring rotation θφ", over(|r| r.spring_turn), "deg"),
        ("spring force τp", over(|r| r.spring_force), "N"),
        ("spring torque τφ", over(|r| r.spring_torque), "N m"),
    ] {
        items.push(Item::compared(
            format!("all points: largest {name}"),
            "0",
            value,
            unit,
            "zero to first order: the mechanism follows offsets of its sliders without strain",
        ));
    }
    items.push(Item::compared(
        "text: shift up to (Q2)",
        "2.02",
        over(|r| largest_size(r.shift)),
        "mm",
        "",
    ));
    items.push(Item::compared(
        "text: change of a passive joint up to (Q2)",
        "0.42",
        over(|r| r.joint),
        "deg",
        "the text prints no unit; degrees as in the table",
    ));
    for ((name, _), (_, second)) in POINTS.iter().zip(&rows) {
        for i in 0..3 {
            items.push(Item::unprinted(
                format!("{name}: exact shift δ{}", i + 1),
                second.shift[i],
                "mm",
                "non-linear equilibrium without a load",
            ));
        }
    }
    Ok(Contents::of(items))
}

/// Printed: shift (mm), rotation (deg), moment (N m), joint (deg), spring shift (mm), spring rotation
/// (deg), spring torque (N m) of Table 6.2; the spring force is `0` in every row.
type Printed = ([&'static str; 3], [&'static str; 3], [&'static str; 5]);
const CASE_B: [Printed; 5] = [
    (
        ["0", "0", "0"],
        ["0.03", "0.03", "0.03"],
        ["2.09", "0.31", "0.05", "0.94", "2.09"],
    ),
    (
        ["0.41", "0.41", "0.41"],
        ["-0.62", "-0.62", "-0.62"],
        ["8.91", "0.63", "0.54", "1.74", "11.96"],
    ),
    (
        ["-0.96", "-0.96", "-0.96"],
        ["0.21", "0.21", "0.21"],
        ["1.48", "0.52", "0.14", "0.80", "1.75"],
    ),
    (
        ["-0.91", "1.31", "0.58"],
        ["-0.19", "-0.49", "0.44"],
        ["4.33", "0.67", "0.99", "1.49", "4.84"],
    ),
    (
        ["0.93", "-0.10", "-0.25"],
        ["0.33", "0.22", "-0.31"],
        ["2.98", "0.59", "0.62", "1.30", "4.0"],
    ),
];

/// The numbers of a row with their names, units and print.
fn cells(row: &Row, printed: &Printed) -> Vec<(String, &'static str, f64, &'static str)> {
    let mut cells = Vec::new();
    for i in 0..3 {
        cells.push((
            format!("shift δ{}", i + 1),
            printed.0[i],
            row.shift[i],
            "mm",
        ));
    }
    for i in 0..3 {
        cells.push((
            format!("rotation φ{}", i + 1),
            printed.1[i],
            row.turn[i],
            "deg",
        ));
    }
    let rest = [
        ("largest moment in the chains, M max", row.moment, "N m"),
        (
            "largest change of a passive joint, Δq max",
            row.joint,
            "deg",
        ),
        ("largest spring translation, θp max", row.spring_shift, "mm"),
        ("largest spring rotation, θφ max", row.spring_turn, "deg"),
        ("largest spring torque, τφ max", row.spring_torque, "N m"),
    ];
    for ((name, value, unit), printed) in rest.into_iter().zip(printed.2) {
        cells.push((name.to_owned(), printed, value, unit));
    }
    cells.push((
        "largest spring force, τp max".to_owned(),
        "0",
        row.spring_force,
        "N",
    ));
    cells
}

/// All legs with the matrix that the parallelogram of leg 1 has in this posture: what the report's
/// program did (see the note of the rows).
fn with_matrices_of_leg_1(own: &Posture) -> Result<Mechanism, Cause> {
    Orthoglide {
        matrix_at: Some(inclination(own, 0)),
        ..Orthoglide::case_b()
    }
    .build()
}

pub(crate) fn table_6_2() -> Result<Contents, Cause> {
    let machine = Orthoglide::case_b().build()?;
    let mut items = Vec::new();
    let mut exact_items = Vec::new();
    let mut rows = Vec::new();
    for ((name, point), printed) in POINTS.iter().zip(&CASE_B) {
        let posture = machine.posture(&target(*point))?;
        let own = linear(&posture, &posture)?;
        let other = with_matrices_of_leg_1(&posture)?;
        let as_printed = linear(&other.posture(&target(*point))?, &posture)?;
        // Legs that are alike have equal matrices.
        let alike = (own.turn[0] - own.turn[1]).abs() < 1e-9;
        for ((cell, print, value, unit), (_, _, copied, _)) in cells(&own, printed)
            .into_iter()
            .zip(cells(&as_printed, printed))
        {
            let note = if alike {
                "to first order, as (6.15)-(6.20); the three legs have the same matrix here"
                    .to_owned()
            } else {
                let near = if is_rounding(print, copied) {
                    ""
                } else {
                    " (not quite the print)"
                };
                format!(
                    "erratum 13 of part 2 (rows Q3 and Q4): with the matrix of leg 1's parallelogram in all three legs {copied:.5} comes out{near}, with each leg's own {value:.5}"
                )
            };
            items.push(Item::erratum(
                format!("{name}: {cell}"),
                print,
                value,
                unit,
                &note,
            ));
        }
        let (second, e) = exact(&posture)?;
        for i in 0..3 {
            exact_items.push(Item::unprinted(
                format!("{name}: exact shift δ{}", i + 1),
                second.shift[i],
                "mm",
                "non-linear equilibrium, each leg's own matrix",
            ));
        }
        for i in 0..3 {
            exact_items.push(Item::unprinted(
                format!("{name}: exact rotation φ{}", i + 1),
                second.turn[i],
                "deg",
                "non-linear equilibrium, each leg's own matrix",
            ));
        }
        exact_items.push(Item::unprinted(
            format!("{name}: exact largest moment in the chains"),
            second.moment,
            "N m",
            "non-linear equilibrium, each leg's own matrix",
        ));
        exact_items.push(Item::unprinted(
            format!("{name}: exact largest force in the chains"),
            largest_size(e.limbs.iter().flat_map(|l| {
                let f = l.wrench.force();
                [f.x, f.y, f.z]
            })),
            "N",
            "zero to first order (the caption's F_i ≠ 0 is erratum 13 of part 2): three independent directions of the legs cannot sum to zero otherwise",
        ));
        rows.push(own);
    }
    items.extend(text(&rows));
    items.extend(exact_items);
    Ok(Contents::of(items))
}

/// Numbers of the text after the table. `rows` are Q0 to Q4.
fn text(rows: &[Row]) -> Vec<Item> {
    let q1 = rows.get(1).copied().unwrap_or_default();
    let over = |value: fn(&Row) -> f64| largest_size(rows.iter().map(value));
    let springs =
        "erratum 14 of part 2: the printed value is the platform's at Q1, not a virtual spring's";
    vec![
        Item::compared(
            "text: moment at a chain's end up to (Q1)",
            "8.91",
            over(|r| r.moment),
            "N m",
            "",
        ),
        Item::erratum(
            "text: translation of virtual springs up to (Q1)",
            "0.41",
            q1.spring_shift,
            "mm",
            springs,
        ),
        Item::erratum(
            "text: rotation of virtual springs up to (Q1)",
            "0.62",
            q1.spring_turn,
            "deg",
            springs,
        ),
        Item::compared(
            "text: torque of virtual springs up to",
            "11.96",
            over(|r| r.spring_torque),
            "N m",
            "",
        ),
        Item::compared(
            "text: change of a passive joint up to (Q3)",
            "0.67",
            over(|r| r.joint),
            "deg",
            "",
        ),
        Item::compared(
            "text: shift of the platform up to (Q3)",
            "1.31",
            over(|r| largest_size(r.shift)),
            "mm",
            "",
        ),
        Item::compared(
            "text: rotation of the platform up to (Q1)",
            "0.62",
            over(|r| largest_size(r.turn)),
            "deg",
            "",
        ),
    ]
}
