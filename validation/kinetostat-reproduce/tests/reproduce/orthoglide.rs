//! The Orthoglide's entries against numbers computed by an independent
//! program and written here digit by digit. Statuses, notes and plots too.

use kinetostat_reproduce::{Entry, Item, Status, one};
use kinetostat_testing::Worst;

fn entry(id: &str) -> Entry {
    one(id).expect(id)
}

fn item<'e>(entry: &'e Entry, name: &str) -> &'e Item {
    entry
        .items
        .iter()
        .find(|i| i.name == name)
        .unwrap_or_else(|| panic!("{} has no item '{name}'", entry.id))
}

fn computed(entry: &Entry, name: &str) -> f64 {
    item(entry, name).computed.expect(name)
}

/// Largest distances from reference numbers, printed for `cargo xtask figures`.
#[derive(Default)]
struct Distances(Worst);

impl Distances {
    fn near(&mut self, what: &str, found: f64, expected: f64, most: f64) {
        let apart = (found - expected).abs();
        assert!(apart <= most, "{what}: {found} instead of {expected}");
        self.0.add(apart);
    }
}

#[allow(clippy::print_stdout, reason = "read by cargo xtask figures")]
fn figure(name: &str, measured: f64, most: f64, unit: &str) {
    println!(
        "figure {{\"name\":\"{name}\",\"measured\":{measured:e},\"asked\":\"at most {most}\",\"unit\":\"{unit}\",\"holds\":{}}}",
        measured <= most
    );
}

fn count(entry: &Entry, status: Status) -> usize {
    entry.items.iter().filter(|i| i.status == status).count()
}

/// What holds for every entry: unprinted items say so, disagreements are explained, plots can be drawn.
fn sound(entry: &Entry) {
    for i in &entry.items {
        assert_eq!(i.printed.is_none(), i.status == Status::NoPrint, "{i:?}");
        assert!(i.computed.is_some_and(f64::is_finite), "{i:?}");
        match i.status {
            Status::Erratum => assert!(i.note.starts_with("erratum "), "{i:?}"),
            Status::NotReproduced => {
                assert!(
                    i.note.to_lowercase().contains("tried") || i.note.contains("artefact"),
                    "{i:?}"
                );
            }
            Status::Agrees | Status::NoPrint => {}
        }
    }
    let mut names: Vec<&str> = entry.items.iter().map(|i| i.name.as_str()).collect();
    names.sort_unstable();
    names
        .windows(2)
        .for_each(|w| assert_ne!(w[0], w[1], "{}", entry.id));
    for plot in &entry.plots {
        assert!(
            plot.x_label.contains(", ") && plot.y_label.contains(", "),
            "units: {plot:?}"
        );
        let svg = plot.svg();
        assert!(
            !svg.contains("NaN") && !svg.contains("no points"),
            "{}",
            plot.title
        );
    }
}

/// By the independent program, bars of 310 mm: linear shift (mm), joint (deg), exact shift.
const TABLE_6_1: [(&str, [f64; 3], f64, [f64; 3]); 5] = [
    (
        "Q0",
        [1.0, 1.0, 1.0],
        0.184825,
        [0.996795, 0.996795, 0.996795],
    ),
    (
        "Q1",
        [0.500613, 0.500613, 0.500613],
        0.135785,
        [0.499872, 0.499872, 0.499872],
    ),
    (
        "Q2",
        [2.018121, 2.018121, 2.018121],
        0.419712,
        [1.987449, 1.987449, 1.987449],
    ),
    (
        "Q3",
        [0.733343, 0.733343, 0.268454],
        0.198910,
        [0.732131, 0.732131, 0.266485],
    ),
    (
        "Q4",
        [0.557970, 0.557970, 1.281490],
        0.259373,
        [0.554476, 0.554476, 1.278541],
    ),
];

#[test]
fn table_6_1_agrees_to_first_order() {
    let e = entry("table-6.1");
    sound(&e);
    let mut worst = Distances::default();
    for (q, linear, joint, exact) in TABLE_6_1 {
        for i in 0..3 {
            let shift = format!("{q}: shift δ{}", i + 1);
            worst.near(&shift, computed(&e, &shift), linear[i], 1e-6);
            let shift = format!("{q}: exact shift δ{}", i + 1);
            worst.near(&shift, computed(&e, &shift), exact[i], 1e-6);
        }
        let name = format!("{q}: largest change of a passive joint, Δq max");
        worst.near(&name, computed(&e, &name), joint, 1e-6);
    }
    figure(
        "reproduce table-6.1: computed against the reference",
        worst.0.value(),
        1e-6,
        "mm or deg",
    );
    let printed = e.items.iter().filter(|i| i.printed.is_some()).count();
    assert_eq!((count(&e, Status::Agrees), printed), (26, 26));
}

/// Point, shift (mm), rotation (deg) and the columns of [`COLUMNS`].
type Row = (&'static str, [f64; 3], [f64; 3], [f64; 5]);

/// By the independent program, each leg with its own matrix and finite errors.
const TABLE_6_2: [Row; 5] = [
    (
        "Q0",
        [0.0, 0.0, 0.0],
        [0.029321, 0.029321, 0.029321],
        [2.09269, 0.31222, 0.05214, 0.94251, 2.09269],
    ),
    (
        "Q1",
        [0.408798, 0.408798, 0.408798],
        [-0.618690, -0.618690, -0.618690],
        [8.91472, 0.62980, 0.54114, 1.74303, 11.95644],
    ),
    (
        "Q2",
        [-0.958750, -0.958750, -0.958750],
        [0.213848, 0.213848, 0.213848],
        [1.48025, 0.52457, 0.13639, 0.80171, 1.74588],
    ),
    (
        "Q3",
        [-0.909040, 1.307696, 0.574977],
        [-0.190535, -0.483799, 0.441793],
        [4.37710, 0.66695, 0.48562, 1.56419, 5.56742],
    ),
    (
        "Q4",
        [0.923709, -0.101021, -0.247072],
        [0.328062, 0.225243, -0.296676],
        [3.32510, 0.58205, 0.22393, 1.31627, 3.97382],
    ),
];

/// The same, "as printed (leg-1 matrix, finite eps)", rows Q3 and Q4.
const LEG_1: [Row; 2] = [
    (
        "Q3",
        [-0.911603, 1.310664, 0.575263],
        [-0.192481, -0.486905, 0.441631],
        [4.32348, 0.66968, 0.98987, 1.48889, 4.84205],
    ),
    (
        "Q4",
        [0.927801, -0.103225, -0.245376],
        [0.332773, 0.218755, -0.306187],
        [2.97998, 0.59007, 0.61877, 1.29643, 3.99836],
    ),
];

const COLUMNS: [&str; 5] = [
    "largest moment in the chains, M max",
    "largest change of a passive joint, Δq max",
    "largest spring translation, θp max",
    "largest spring rotation, θφ max",
    "largest spring torque, τφ max",
];

fn row_names(q: &str) -> Vec<String> {
    let shift = (1..4).map(|i| format!("{q}: shift δ{i}"));
    let turn = (1..4).map(|i| format!("{q}: rotation φ{i}"));
    let rest = COLUMNS.iter().map(|c| format!("{q}: {c}"));
    shift.chain(turn).chain(rest).collect()
}

#[test]
fn table_6_2_has_errata_where_one_leg_stood_for_all() {
    let e = entry("table-6.2");
    sound(&e);
    let mut worst = Distances::default();
    for (q, shift, turn, rest) in TABLE_6_2 {
        let values = shift.iter().chain(&turn).chain(&rest);
        for (k, (name, expected)) in row_names(q).iter().zip(values).enumerate() {
            let most = if k < 6 { 1e-6 } else { 1e-5 };
            worst.near(name, computed(&e, name), *expected, most);
            if ["Q0", "Q1", "Q2"].contains(&q) {
                assert_eq!(item(&e, name).status, Status::Agrees, "{name}");
            }
        }
        assert_eq!(
            item(&e, &format!("{q}: largest spring force, τp max")).status,
            Status::Agrees
        );
    }
    figure(
        "reproduce table-6.2: computed against the reference",
        worst.0.value(),
        1e-5,
        "mm, deg or N m",
    );
    for (q, shift, turn, rest) in LEG_1 {
        let values = shift.iter().chain(&turn).chain(&rest);
        for (name, expected) in row_names(q).iter().zip(values) {
            let i = item(&e, name);
            assert!(
                matches!(i.status, Status::Agrees | Status::Erratum),
                "{i:?}"
            );
            let said = i
                .note
                .split("three legs ")
                .nth(1)
                .and_then(|t| t.split(' ').next());
            let said: f64 = said.and_then(|t| t.parse().ok()).expect(name);
            assert!(
                (said - expected).abs() < 1.1e-5,
                "{name}: {said} {expected}"
            );
        }
    }
    // The clearest of the errata: 0.99 and 0.62 mm are 0.49 and 0.22 mm.
    for q in ["Q3", "Q4"] {
        for column in [COLUMNS[0], COLUMNS[2]] {
            assert_eq!(item(&e, &format!("{q}: {column}")).status, Status::Erratum);
        }
    }
    for (name, value) in [
        ("text: translation of virtual springs up to (Q1)", 0.54114),
        ("text: rotation of virtual springs up to (Q1)", 1.74303),
    ] {
        let i = item(&e, name);
        assert_eq!(i.status, Status::Erratum);
        assert!((i.computed.expect(name) - value).abs() < 1e-5);
    }
    assert_eq!(count(&e, Status::NotReproduced), 0);
    // Non-linear rows of section 2.2.
    for (name, value) in [
        ("Q1: exact largest moment in the chains", 9.135231),
        ("Q1: exact largest force in the chains", 0.945304),
        ("Q3: exact largest moment in the chains", 4.427330),
        ("Q4: exact shift δ1", 0.927647),
        ("Q4: exact rotation φ3", -0.295835),
    ] {
        assert!((computed(&e, name) - value).abs() < 1.1e-6, "{name}");
    }
}

#[test]
fn table_5_3_and_its_figure() {
    let e = entry("table-5.3");
    sound(&e);
    // Section 2.3: distances, peaks outside, forces at the printed displacements inside.
    let mut worst = Distances::default();
    for (name, expected, most) in [
        ("Q2: distance d0 to the flat posture", 91.64, 0.005),
        ("Q2a: distance d0 to the flat posture", 46.00, 0.005),
        ("Q2b: distance d0 to the flat posture", 11.36, 0.005),
        ("Q2: force at the printed Δ_cr outside", -2.03, 0.006),
        ("Q2a: F_cr outside", -0.7085, 0.00005),
        ("Q2a: Δ_cr outside", -16.98, 0.005),
        ("Q2b: F_cr outside", -0.01138, 0.00002),
        ("Q2b: Δ_cr outside", -4.64, 0.005),
        ("Q2: force at the printed Δ_cr inside", 2.1997, 0.00005),
        ("Q2a: force at the printed Δ_cr inside", 1.414, 0.001),
        ("Q2b: force at the printed Δ_cr inside", 0.910, 0.001),
    ] {
        worst.near(name, computed(&e, name), expected, most);
    }
    figure(
        "reproduce table-5.3: computed against the reference",
        worst.0.value(),
        0.006,
        "mm or kN",
    );
    // Section 2.3 of the reference values, as it is rounded there.
    for (q, value, most) in [
        ("Q2", 408.00, 5e-3),
        ("Q2a", 94.24, 5e-3),
        ("Q2b", 5.424, 5e-4),
    ] {
        let found = computed(&e, &format!("{q}: K0 along (1, 1, 1), orientation held"));
        assert!((found - value).abs() < most, "{q}: {found}");
    }
    // The report's iteration stops converging between -5.5 and -5.7 mm.
    let stops = "Q2: displacement outside where the report's iteration stops converging";
    assert!((-5.7..-5.5).contains(&computed(&e, stops)));
    for q in ["Q2", "Q2a", "Q2b"] {
        let apart = computed(
            &e,
            &format!("{q}: whole machine against three times one leg"),
        );
        assert!(apart < 1e-8, "{q}: {apart}");
    }
    let status = |name: &str| item(&e, name).status;
    for (name, expected) in [
        ("Q2: distance d0 to the flat posture", Status::NotReproduced),
        ("Q2a: distance d0 to the flat posture", Status::Agrees),
        ("Q2b: distance d0 to the flat posture", Status::Agrees),
        ("Q2: F_cr outside", Status::NotReproduced),
        ("Q2: Δ_cr outside", Status::NotReproduced),
        ("Q2: F_cr inside", Status::Agrees),
        ("Q2: Δ_cr inside", Status::Agrees),
        ("Q2a: F_cr outside", Status::NotReproduced),
        ("Q2a: F_cr inside", Status::NotReproduced),
        ("Q2b: F_cr outside", Status::Agrees),
        ("Q2b: Δ_cr outside", Status::Agrees),
        ("Q2b: F_cr inside", Status::NotReproduced),
        ("footnote: coordinate of Q2", Status::Erratum),
        ("(5.45): Δ_cr / d0 of the toggle frame", Status::Agrees),
    ] {
        assert_eq!(status(name), expected, "{name}");
    }
    assert!((computed(&e, "footnote: coordinate of Q2") + 73.65).abs() < 1e-9);
    // Bars that bow have no knee inside and the same toggle outside.
    for (q, force) in [("Q2", 2.1997), ("Q2a", 1.414), ("Q2b", 0.910)] {
        let name = format!("{q}: force at the printed Δ_cr inside, bars that bow");
        assert!(computed(&e, &name) > 1.01 * force && item(&e, &name).note.contains("no knee"));
    }
    let bowed = computed(&e, "Q2a: F_cr outside, bars that bow");
    assert!((bowed + 0.7085).abs() < 0.002, "{bowed}");

    let figure = entry("fig-5.11");
    sound(&figure);
    assert_eq!(figure.plots.len(), 4);
    assert!(figure.plots[0].lines.iter().any(|l| l.dashed));
    assert_eq!(
        item(&figure, "caption: distance to the singularity").status,
        Status::Agrees
    );
}

#[test]
fn superposition_along_the_milling_line() {
    // Section 2.5: largest 0.0225 (A) and 0.0206 mm (B), mean 0.0074 and 0.0106; the force alone
    // moves the platform by 0.21 to 0.37 mm.
    for (id, most, mean) in [("fig-6.6", 0.0225, 0.0074), ("fig-6.7", 0.0206, 0.0106)] {
        let e = entry(id);
        sound(&e);
        let mut worst = Distances::default();
        for (name, expected, tolerance) in [
            ("largest difference of sum (5) and total (4)", most, 5e-5),
            ("mean difference of sum (5) and total (4)", mean, 5e-5),
            ("smallest displacement by the force alone (2)", 0.21, 5e-3),
            ("largest displacement by the force alone (2)", 0.37, 5e-3),
        ] {
            worst.near(name, computed(&e, name), expected, tolerance);
        }
        figure(
            &format!("reproduce {id}: computed against the reference"),
            worst.0.value(),
            5e-3,
            "mm",
        );
        assert_eq!((count(&e, Status::Agrees), e.plots.len()), (3, 2));
        assert!(e.plots.iter().all(|p| p.lines.len() == 5));
    }
}

/// Numbers of the four readings in a note.
fn readings(note: &str) -> Vec<f64> {
    let list = note.split("Tried, in ").nth(1).unwrap_or_default();
    list.split("; ")
        .filter_map(|r| r.rsplit(' ').next()?.parse().ok())
        .collect()
}

#[test]
fn chapter_7_by_its_readings() {
    let (q1, all) = (entry("fig-7.7"), entry("fig-7.8"));
    let mut worst = Distances::default();
    // Section 2.6: readings A, A', B, B'; a dash where it gives no number.
    let dash = f64::NAN;
    let none = Status::NotReproduced;
    for (e, name, half, expected, status) in [
        (
            &q1,
            "Q1: compliance errors without compensation can exceed",
            0.0005,
            [0.905, 0.755, 0.998, 1.071],
            none,
        ),
        (
            &q1,
            "Q1: change of the actuators, norm of the three, up to",
            0.005,
            [1.73, 1.67, 1.54, 1.55],
            Status::Agrees,
        ),
        (
            &q1,
            "Q1: force of an actuator up to",
            0.5,
            [397.0, 350.0, 324.0, 324.0],
            none,
        ),
        (
            &all,
            "Q0: deflection by the cutting force",
            0.0005,
            [0.088, 0.075, 0.334, 0.362],
            none,
        ),
        (
            &all,
            "Q3: deflection by the cutting force",
            0.0005,
            [1.194, 1.07, 1.210, 1.270],
            none,
        ),
        (
            &all,
            "Q0: change of the actuators, norm of the three, up to",
            0.005,
            [0.20, dash, 0.42, 0.44],
            none,
        ),
        (
            &all,
            "Q3: change of the actuators, norm of the three, up to",
            0.005,
            [1.92, dash, 1.73, 1.76],
            Status::Agrees,
        ),
        (
            &all,
            "Q3: compliance errors without compensation can exceed",
            0.0005,
            [1.194, 1.07, 1.210, 1.270],
            Status::Agrees,
        ),
    ] {
        let i = item(e, name);
        assert_eq!(i.status, status, "{name}");
        let found = readings(&i.note);
        assert_eq!(found.len(), 4, "{}", i.note);
        // The reference samples its circles every 15 degrees, where largest values come out up to 1 %
        // lower; its row A' at Q0 and Q3 differs by 2 % for a reason that is not known.
        for ((f, x), most) in found.iter().zip(expected).zip([0.005, 0.03, 0.01, 0.01]) {
            if !x.is_nan() {
                let apart = ((f - x).abs() - half).max(0.0) / x;
                worst.near(name, apart, 0.0, most);
            }
        }
    }
    figure(
        "reproduce fig-7.7 and 7.8: readings against the reference",
        worst.0.value(),
        0.03,
        "relative",
    );
    for e in [&q1, &all] {
        sound(e);
        for i in e.items.iter().filter(|i| i.name.contains("distance left")) {
            assert!(i.computed.is_some_and(|x| x < 1e-9), "{i:?}");
        }
        for i in e
            .items
            .iter()
            .filter(|i| i.name.contains("steps of (7.13)"))
        {
            assert!(
                i.computed.is_some_and(|x| (4.0..=6.0).contains(&x)),
                "{i:?}"
            );
        }
    }
    assert_eq!((q1.plots.len(), all.plots.len()), (6, 5));
}

/// [R 7.5] under both readings of the drives' stiffness, section 2.6.
#[test]
fn sources_of_error_add_and_their_paths_lie_as_the_text_says() {
    let (paths, sums) = (entry("fig-7.5"), entry("fig-7.6"));
    sound(&paths);
    sound(&sums);
    assert_eq!((paths.plots.len(), sums.plots.len()), (2, 2));
    for reading in ["A", "B"] {
        let of = |name: &str| computed(&paths, &format!("reading {reading}: {name}"));
        // The text: the centre of path 5 lies opposite to that of path 4, its longest axis across.
        for letter in ["x", "y"] {
            let four = of(&format!("centre of path (4): {letter}"));
            let five = of(&format!("centre of path (5), opposite to (4): {letter}"));
            assert!(four * five < 0.0 && (four + five).abs() < 0.01);
        }
        let across = (of("longest axis of path (4)") - of("longest axis of path (5)")).abs();
        assert!((across - 90.0).abs() < 10.0, "{across}");
        // Section 2.6: the paths intersect with rigid drives only; below 3e4 N/mm they do not.
        let least = of("radius of (3) less that of (1), smallest");
        assert_eq!(least < 0.0, reading == "A", "{reading} {least}");
        // The text: the total is less than the sum.
        let of = |name: &str| computed(&sums, &format!("reading {reading}: {name}"));
        let excess = of("smallest excess of (3) over (4) in length");
        assert!(excess > 0.0, "{reading} {excess}");
    }
    // Section 2.6: 0.003 (Q0), 0.06 to 0.09 (Q1), 0.04 mm (Q3).
    let of = |name: &str| computed(&sums, &format!("reading A: {name}"));
    assert!((of("Q0: largest difference of (3) and (4)") - 0.003).abs() < 5e-4);
    assert!((0.06..0.09).contains(&of("Q1: largest difference of (3) and (4)")));
    assert!((of("Q3: largest difference of (3) and (4)") - 0.04).abs() < 5e-3);
}

/// [R 7.2]: each trial leaves what is not linear of the one before, so that the error falls by the same order each time, and one
/// trial of a linear machine would do.
#[test]
fn the_symmetrical_trajectory_leaves_what_is_not_linear() {
    let trials = entry("fig-7.2");
    sound(&trials);
    assert_eq!(trials.plots.len(), 2);
    let names = [
        "as drawn",
        "mirrored once",
        "mirrored twice",
        "mirrored three times",
    ];
    let of = |reading: &str, name: &str| computed(&trials, &format!("reading {reading}: {name}"));
    for reading in ["A", "B"] {
        let errors = names.map(|name| of(reading, &format!("largest error, {name}")));
        // The first as in figure 7.7: compliance errors above 0.8 mm beside those of the legs.
        assert!(errors[0] > 0.8 && errors[0] < 2.0, "{errors:?}");
        for pair in errors.windows(2) {
            assert!(pair[1] < 0.1 * pair[0] || pair[1] < 1e-7, "{errors:?}");
        }
        // The factor is that of the machine, not of the trial.
        let factors = [errors[1] / errors[0], errors[2] / errors[1]];
        assert!(factors[1] < 2.0 * factors[0], "{factors:?}");
        let ratio = of(reading, "error mirrored once, by that with half the force");
        assert!(ratio > 1.0 && ratio < 4.5, "{ratio}");
    }
}
