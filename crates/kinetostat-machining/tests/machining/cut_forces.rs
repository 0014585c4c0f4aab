//! Forces of the cut along a program: where the tool cuts, in which axes, and what it asks for.

use std::sync::Arc;

use kinetostat_cutting::{
    Engagement, Feed, Linear, Milling, Rotation, Shape, Side, Stock, StockSettings, Tool,
};
use kinetostat_machining::{
    CutFailure, CutFindingKind, CutQuestion, CuttingLoad, CuttingTool, EngagementSource,
    ForceAlongPath, ForceChoice, LoadAlongPath, Placement, ProgramLoad, StockAlong, Unwatched,
};
use kinetostat_program::{Path, Program, ReadOptions, interpret};
use kinetostat_testing::Worst;
use nalgebra::{Rotation3, Vector3, vector};

fn path(text: &str) -> Path {
    interpret(&Program::read(text).unwrap(), &ReadOptions::default()).unwrap()
}

fn tool() -> Tool {
    Tool::new(Shape::Flat, 6.0, 2)
        .unwrap()
        .with_helix(0.5)
        .unwrap()
}

fn law() -> Linear {
    Linear::new([796.0, 168.0, 222.0], [27.7, 30.8, 1.4]).unwrap()
}

fn question(engagement: EngagementSource) -> CutQuestion {
    CutQuestion {
        tools: vec![CuttingTool::new(tool(), Arc::new(law()))],
        engagement,
        choice: ForceChoice::Mean,
        rpm: None,
        rotation: None,
        spindle: None,
    }
}

fn block(low: [f64; 3], high: [f64; 3]) -> EngagementSource {
    let settings = StockSettings::for_tool(&tool());
    EngagementSource::Stock(Box::new(Stock::block(low, high, &settings).unwrap()))
}

fn along(source: EngagementSource, path: &Path) -> ForceAlongPath {
    question(source).along(path, &Unwatched).unwrap()
}

fn exact(width: f64, depth: f64, part: Side, feed: f64) -> Vector3<f64> {
    let (tool, law) = (tool(), law());
    let engagement = Engagement::straight(3.0, width, depth, part).unwrap();
    let cut = Milling::new(&tool, &law, &engagement, Feed::level(feed).unwrap());
    cut.mean().force_n
}

const START: &str = "G21 G90\nS10000 M3\nG0 X-10 Y0 Z5\n";

/// A slot through a block: air before it, the force of a slot in it, air behind it; the second pass cuts air.
#[test]
fn a_slot_and_a_second_pass() {
    let path = path(&format!("{START}G1 Z-2 F600\nG1 X50\nG1 X-10\n"));
    let along = along(block([0.0, -20.0, -10.0], [40.0, 20.0, 0.0]), &path);
    let slot = exact(6.0, 2.0, Side::Left, 600.0 / 10_000.0 / 2.0);
    let at = |x: f64| along.wrench(2, (x + 10.0) / 60.0);
    for x in [5.0, 17.3, 36.0] {
        let force = at(x).force();
        assert!(
            (force - slot).norm() < 0.01 * slot.norm(),
            "{x}: {force} {slot}"
        );
    }
    for x in [-9.0, -3.5, 44.0, 49.0] {
        assert!(at(x).force().norm() < 1e-9, "{x}: {}", at(x).force());
    }
    for share in [0.1, 0.5, 0.9] {
        assert!(along.wrench(3, share).force().norm() < 1e-9);
    }
    assert!(along.findings.is_empty(), "{:?}", along.findings);
    // The load needs few places: a cut that does not change has no vertices in it.
    assert!(along.breaks(2).len() < 30, "{:?}", along.breaks(2));
}

/// Half the width in the material, on both sides, in any direction: the force turns with the feed.
#[test]
fn the_force_turns_with_the_feed() {
    let feed = 0.03;
    let mut compared = 0;
    for (turn, part, y) in [
        (0.0, Side::Right, 3.0),
        (37.0, Side::Left, -3.0),
        (-120.0, Side::Right, 3.0),
    ] {
        let rotation = Rotation3::from_axis_angle(&Vector3::z_axis(), f64::to_radians(turn));
        // A wall along the feed: the block is under the tool's right or left half only.
        let constant = Engagement::straight(3.0, 2.0, 1.5, part).unwrap();
        let to = rotation * vector![30.0, 0.0, 0.0];
        let path = path(&format!(
            "G21 G90\nS10000 M3\nG0 X0 Y0 Z0\nG1 X{:.6} Y{:.6} F600\n",
            to.x, to.y
        ));
        let along = along(EngagementSource::Constant(constant), &path);
        let load = ProgramLoad::new(CuttingLoad::FromCut {
            origin: kinetostat_machining::ForceOrigin::Computed,
            largest: along.largest(),
        });
        let load = LoadAlongPath::new(load, &path).with_cut(Some(&along));
        let tilt = Rotation3::from_euler_angles(0.3, -0.2, 0.5);
        let mut placement = Placement::at(vector![0.1, 0.2, 0.3]);
        placement.base_from_part.rotation = tilt.into();
        let found = load.wrench(&placement, 1, 0.4).force();
        let expected = tilt * (rotation * exact(2.0, 1.5, part, feed));
        assert!(
            (found - expected).norm() < 1e-4 * expected.norm(),
            "{found} {expected}, {y}"
        );
        compared += 1;
    }
    assert_eq!(compared, 3);
}

/// M4 is the mirror image of M3.
#[test]
fn counter_clockwise_mirrors() {
    let run = |m: &str, part: Side| {
        let path = path(&format!("G21 G90\nS10000 {m}\nG0 X0 Y0 Z0\nG1 X30 F600\n"));
        let constant = Engagement::straight(3.0, 2.0, 1.5, part).unwrap();
        along(EngagementSource::Constant(constant), &path)
            .wrench(1, 0.5)
            .force()
    };
    let (a, b) = (run("M3", Side::Right), run("M4", Side::Left));
    assert!((a.x - b.x).abs() < 1e-9 && (a.y + b.y).abs() < 1e-9 && (a.z - b.z).abs() < 1e-9);
    assert!(a.y.abs() > 1.0);
}

/// A plunge pushes the tool up and nowhere else.
#[test]
fn a_plunge_pushes_up() {
    let path = path("G21 G90\nS10000 M3\nG0 X10 Y3 Z5\nG1 Z-2 F200\n");
    let along = along(block([0.0, -20.0, -10.0], [40.0, 20.0, 0.0]), &path);
    let wrench = along.wrench(1, 6.5 / 7.0);
    // Two lips of 3 mm, chips of 0.01 mm, the radial part of the law.
    let thrust = 2.0 * 3.0 * (168.0 * 0.01 + 30.8);
    assert!(
        (wrench.force() - Vector3::z() * thrust).norm() < 0.02 * thrust,
        "{}",
        wrench.force()
    );
    assert!(along.wrench(1, 4.0 / 7.0).force().norm() < 1e-9);
    assert_eq!(along.findings.len(), 1);
    assert_eq!(along.findings[0].kind, CutFindingKind::Plunge);
    assert_eq!(along.findings[0].line, 4);
}

/// What is missing is asked for by name and line, and only where something is cut.
#[test]
fn what_is_missing_is_named() {
    let ask = |text: &str| {
        question(block([0.0, -20.0, -10.0], [40.0, 20.0, 0.0])).along(&path(text), &Unwatched)
    };
    let missing = |text: &str, line: usize, word: &str| match ask(text) {
        Err(error @ CutFailure::Missing { line: found, .. }) => {
            assert_eq!(found, line, "{error}");
            assert!(error.to_string().contains(word), "{error}");
        }
        other => panic!("{other:?}"),
    };
    missing(
        "G21 G90\nS10000\nG0 X-10 Y0 Z-2\nG1 X5 F600\n",
        4,
        "M3 or M4",
    );
    missing("G21 G90\nM3\nG0 X-10 Y0 Z-2\nG1 X5 F600\n", 4, "S with G97");
    missing("G21 G90\nM3 S10000\nG0 X-10 Y0 Z-2\nG1 X5\n", 4, "(F)");
    // Air asks for nothing.
    let air = ask("G21 G90\nG0 X-10 Y0 Z5\nG1 X5\n").unwrap();
    assert_eq!(air.largest().force().norm(), 0.0);
    // No tool at all, and tools that nobody has described.
    let mut none = question(block([0.0, -20.0, -10.0], [40.0, 20.0, 0.0]));
    none.tools.clear();
    let failure = none.along(&path("G21 G90\nG0 X-10 Y0 Z-2\nG1 X5 F600\n"), &Unwatched);
    assert_eq!(failure.unwrap_err(), CutFailure::NoTool { line: 3 });
    let mut numbered = question(block([0.0, -20.0, -10.0], [40.0, 20.0, 0.0]));
    numbered.tools[0].number = Some(3);
    let failure = numbered.along(
        &path("G21 G90\nT4 M6\nS10000 M3\nG0 X-10 Y0 Z-2\nG1 X5 F600\n"),
        &Unwatched,
    );
    assert_eq!(
        failure.unwrap_err(),
        CutFailure::UnknownTool { line: 5, number: 4 }
    );
    let failure = numbered.along(
        &path("G21 G90\nS10000 M3\nG0 X-10 Y0 Z-2\nG1 X5 F600\n"),
        &Unwatched,
    );
    assert_eq!(failure.unwrap_err(), CutFailure::NoTool { line: 4 });
}

/// Forces by lines, and a sense and speed that the program does not state.
#[test]
fn lines_and_speeds_from_the_question() {
    let path = path("G21 G90\nG0 X0 Y0 Z0\nG1 X10 F600\nG1 X20\nG1 X30\n");
    let cut = Engagement::straight(3.0, 2.0, 1.5, Side::Right).unwrap();
    let mut question = question(EngagementSource::Lines(vec![(4..=4, cut)]));
    question.rpm = Some(5000.0);
    question.rotation = Some(Rotation::Clockwise);
    let along = question.along(&path, &Unwatched).unwrap();
    let expected = exact(2.0, 1.5, Side::Right, 0.06);
    assert!((along.wrench(2, 0.5).force() - expected).norm() < 1e-4 * expected.norm());
    for other in [1, 3] {
        assert_eq!(along.wrench(other, 0.5).force().norm(), 0.0);
    }
}

/// A rapid through the material is told.
#[test]
fn a_rapid_through_the_stock_is_told() {
    let path = path("G21 G90\nS10000 M3\nG0 X-10 Y0 Z-2\nG0 X20\n");
    let along = along(block([0.0, -20.0, -10.0], [40.0, 20.0, 0.0]), &path);
    assert_eq!(along.findings.len(), 1);
    assert_eq!(
        (along.findings[0].kind, along.findings[0].line),
        (CutFindingKind::RapidThroughStock, 4)
    );
}

/// Cuts that nobody makes are told: feeds in mm/s, tips far below the stock, a right-hand helix with M4, and a ramp so flat that
/// edge forces under the end are a guess, with the force that is left without them.
#[test]
fn cuts_that_nobody_makes_are_told() {
    let stock = || block([0.0, -20.0, -10.0], [60.0, 20.0, 0.0]);
    let told = |text: &str, rotation: Option<Rotation>| {
        let mut question = question(stock());
        question.rotation = rotation;
        let along = question.along(&path(text), &Unwatched).unwrap();
        let found = along.findings.iter();
        found.map(|f| (f.kind, f.text.clone())).collect::<Vec<_>>()
    };
    let kinds = |text: &str, rotation| -> Vec<CutFindingKind> {
        told(text, rotation)
            .into_iter()
            .map(|(kind, _)| kind)
            .collect()
    };
    use CutFindingKind::{
        BelowTheStock, DeepCut, EndBeyondTheLaw, LeftHandTool, Plunge, ThickChip, ThinFeed,
    };
    let slot = |m: &str, z: f64, f: f64| {
        format!("G21 G90\nS10000 {m}\nG0 X-10 Y0 Z5\nG0 Z{z}\nG1 X50 F{f}\n")
    };
    assert_eq!(kinds(&slot("M3", -2.0, 600.0), None), []);
    assert_eq!(kinds(&slot("M3", -2.0, 20.0), None), [ThinFeed]);
    assert_eq!(kinds(&slot("M3", -2.0, 13_000.0), None), [ThickChip]);
    // Edges 50 to 60 mm above the tip would cut.
    let below = kinds(&slot("M3", -60.0, 600.0), None);
    assert_eq!(below, [DeepCut, BelowTheStock]);
    assert_eq!(kinds(&slot("M4", -2.0, 600.0), None), [LeftHandTool]);
    assert_eq!(
        kinds(&slot("M4", -2.0, 600.0), Some(Rotation::CounterClockwise)),
        []
    );
    // 1:24 down through the block: 0.00125 mm per tooth under the end.
    let ramp = "G21 G90\nS10000 M3\nG0 X-10 Y0 Z0.4\nG1 X38 Z-1.6 F600\n";
    let found = told(ramp, None);
    let of_kinds: Vec<CutFindingKind> = found.iter().map(|(kind, _)| *kind).collect();
    assert_eq!(of_kinds, [Plunge, EndBeyondTheLaw]);
    assert!(found[0].1.contains("2.39 degrees"), "{}", found[0].1);
    // Two lips of 3 mm with 168 N/mm2 x 0.00125 mm and 30.8 N/mm.
    let end_n = 6.0 * (168.0 * 0.03 * 2.0 / 48.0416 + 30.8);
    assert!(
        found[1].1.contains(&format!("{end_n:.0} of ")),
        "{} {end_n}",
        found[1].1
    );
}

/// A stock beside the program is refused with both places, whatever the program.
#[test]
fn a_stock_beside_the_program_is_refused() {
    let path = path(&format!("{START}G1 Z-2 F600\nG1 X50\n"));
    let failure = question(block([0.0, 430.0, -10.0], [60.0, 470.0, 0.0]))
        .along(&path, &Unwatched)
        .unwrap_err();
    let text = failure.to_string();
    assert!(matches!(failure, CutFailure::BesideStock { .. }), "{text}");
    assert!(
        text.contains("from (0, 430, -10) to (60, 470, 0) mm") && text.contains("(50, 0, 5)"),
        "{text}"
    );
}

/// A cut in many short moves: the load is that of one long move, and does not jump from move to move.
#[test]
fn short_moves_have_the_load_of_a_long_one() {
    let one = path(&format!("{START}G1 Z-2 F600\nG1 X50\n"));
    let mut text = format!("{START}G1 Z-2 F600\n");
    for i in 1..=150 {
        text.push_str(&format!("G1 X{:.4}\n", -10.0 + 0.4 * f64::from(i)));
    }
    let many = path(&text);
    let stock = || block([0.0, -20.0, -10.0], [40.0, 20.0, 0.0]);
    let (a, b) = (along(stock(), &one), along(stock(), &many));
    let slot = a.largest().force().norm();
    let mut compared = 0;
    for i in 0..150 {
        for share in [0.0, 0.5, 1.0] {
            let x = 0.4 * (f64::from(i) + share);
            let (one, other) = (a.wrench(2, x / 60.0), b.wrench(2 + i as usize, share));
            // Entry and exit are a step at a wall in a slot: there places within half a cell differ.
            let at_a_wall = [7.0, 10.0, 47.0, 50.0]
                .iter()
                .any(|wall| (x - wall).abs() < 3.2);
            let off = (one.force() - other.force()).norm();
            assert!(at_a_wall || off < 0.02 * slot, "{x}: {off} of {slot}");
            compared += usize::from(!at_a_wall);
        }
        if i > 0 {
            let jump =
                b.wrench(2 + i as usize, 0.0).force() - b.wrench(1 + i as usize, 1.0).force();
            assert!(jump.norm() < 1e-9, "{i}: {jump}");
        }
    }
    assert!(compared > 250, "{compared}");
}

/// Half of the end goes down beside an edge: the force across the axis is there, whatever little direction the move has.
#[test]
fn a_plunge_at_an_edge_pushes_sideways() {
    let force = |to: &str| {
        let path = path(&format!(
            "G21 G90\nS12000 M3\nG0 X20 Y20 Z0.5\nG1 {to} F2000\n"
        ));
        let along = along(block([0.0, -20.0, -10.0], [40.0, 20.0, 0.0]), &path);
        let load = ProgramLoad::new(CuttingLoad::FromCut {
            origin: kinetostat_machining::ForceOrigin::Computed,
            largest: along.largest(),
        });
        let load = LoadAlongPath::new(load, &path).with_cut(Some(&along));
        load.wrench(&Placement::at(Vector3::zeros()), 1, 0.8)
            .force()
    };
    // Two lips of 3 mm over half a turn, chips of 1/12 mm: f = K_c c + K_e on the end. Material is at y below 20, so the mean of
    // the way of the lip there points along x: tangential forces add up to 2 x 3 f_t / pi, and across it the meridian's part.
    let chip = 2000.0 / 12_000.0 / 2.0;
    let f = [796.0 * chip + 27.7, 168.0 * chip + 30.8, 222.0 * chip + 1.4];
    let mean = 2.0 * 3.0 / std::f64::consts::PI;
    let expected = vector![mean * f[0], -mean * f[2], 0.5 * 2.0 * 3.0 * f[1]];
    for to in ["Z-3", "X20.0005 Z-3", "Y20.0005 Z-3"] {
        let found = force(to);
        assert!(
            (found - expected).norm() < 0.03 * expected.norm(),
            "{to}: {found} {expected}"
        );
    }
}

/// Known for chips of 0.02 to 0.1 mm.
#[derive(Debug)]
struct Known(Linear);

impl kinetostat_cutting::ForceLaw for Known {
    fn edge_force(&self, chip_mm: f64) -> kinetostat_cutting::EdgeForce {
        self.0.edge_force(chip_mm)
    }

    fn known_between_mm(&self) -> Option<(f64, f64)> {
        Some((0.02, 0.1))
    }
}

/// The thickest chip counts, not the feed: `c sin(acos(1 - ae/r))` in a narrow cut.
#[test]
fn chips_outside_the_law_are_told() {
    let mut compared = 0;
    // Feed per tooth, width, thickest chip: within, too thick, too thin, and thin by a narrow cut of a fast feed.
    for (feed, width, told) in [
        (0.05, 3.0, false),
        (0.12, 3.0, true),
        (0.01, 3.0, true),
        (0.12, 0.1, false),
        (0.06, 0.05, true),
    ] {
        let path = path(&format!(
            "G21 G90\nS10000 M3\nG0 X0 Y0 Z0\nG1 X30 F{}\n",
            feed * 20_000.0
        ));
        let cut = Engagement::straight(3.0, width, 1.0, Side::Right).unwrap();
        let mut question = question(EngagementSource::Constant(cut));
        question.tools[0].law = Arc::new(Known(law()));
        let along = question.along(&path, &Unwatched).unwrap();
        let found = along
            .findings
            .iter()
            .any(|f| f.kind == CutFindingKind::OutsideTheLaw);
        assert_eq!(found, told, "{feed} {width}: {:?}", along.findings);
        compared += 1;
    }
    assert_eq!(compared, 5);
}

/// Circles along walls that are round about the same centre, inside and outside, as G3 and G2: the arc in contact is that of two
/// circles, however the stock's cells divide the way.
#[test]
fn arcs_have_the_engagement_of_two_circles() {
    let radius = 3.0_f64;
    let contact = |path: f64, wall: f64| {
        // Angle between the way to the wall's centre and that to the end of the contact.
        let cosine = (path * path + radius * radius - wall * wall) / (2.0 * path * radius);
        cosine.acos()
    };
    let mut worst = [Worst::new(), Worst::new()];
    for (which, cell) in [0.3, 0.15].into_iter().enumerate() {
        for (rho, step) in [(12.0, 1.5), (2.0, 1.0), (20.0, 0.5)] {
            // Inside: a hole is made with a smaller circle first, and the wall lies outside of the tool's way.
            let before = rho - step;
            let hole = format!(
                "G21 G90\nS12000 M3\nG0 X0 Y0 Z5\nG1 Z-2 F100\nG1 X{before} F600\nG3 X{before} Y0 I-{before} J0\nG1 X{rho}\nG3 X{rho} Y0 I-{rho} J0\n"
            );
            // The way out from the old circle needs a while; behind a half turn only the new one counts.
            let found = arcs_of_last_move(&hole, cell);
            let wall = before + radius;
            let exact = std::f64::consts::PI - contact(rho, wall);
            for (share, arc) in found.iter().filter(|(share, _)| (0.3..0.7).contains(share)) {
                worst[which].add_at((arc - exact).abs(), || {
                    format!("inside {rho} at {share}: {arc} {exact}")
                });
            }
            // Outside: a disc is turned around, from a larger circle to a smaller one.
            let out = rho + 8.0;
            let disc = format!(
                "G21 G90\nS12000 M3\nG0 X{} Y0 Z5\nG1 Z-2 F100\nG2 X{} Y0 I-{} J0 F600\nG1 X{out}\nG2 X{out} Y0 I-{out} J0\n",
                out + step,
                out + step,
                out + step
            );
            let found = arcs_of_last_move(&disc, cell);
            let exact = contact(out, out + step - radius);
            for (share, arc) in found.iter().filter(|(share, _)| (0.3..0.7).contains(share)) {
                worst[which].add_at((arc - exact).abs(), || {
                    format!("outside {out} at {share}: {arc} {exact}")
                });
            }
        }
    }
    let [coarse, fine] = worst.map(|w| w.value());
    assert!(coarse < 0.03, "{coarse}");
    assert!(fine < 0.6 * coarse, "{fine} {coarse}");
}

/// Shares and arcs (rad) of the last move of a program in a block, for a tool of 6 mm.
fn arcs_of_last_move(text: &str, cell_mm: f64) -> Vec<(f64, f64)> {
    let path = interpret(&Program::read(text).unwrap(), &ReadOptions::default()).unwrap();
    let tool = Tool::new(Shape::Flat, 6.0, 2).unwrap();
    let settings = StockSettings::with_cell_mm(cell_mm).unwrap();
    let stock = Stock::block([-45.0, -45.0, -6.0], [45.0, 45.0, 0.0], &settings).unwrap();
    let law = Arc::new(Linear::new([800.0, 200.0, 0.0], [0.0; 3]).unwrap());
    let question = CutQuestion {
        tools: vec![CuttingTool::new(tool, law)],
        engagement: EngagementSource::Stock(Box::new(stock)),
        choice: ForceChoice::Mean,
        rpm: None,
        rotation: None,
        spindle: None,
    };
    let forces = question.along(&path, &Unwatched).unwrap();
    let last = forces.stations(path.moves.len() - 1);
    assert!(last.len() > 10);
    last.iter()
        .map(|station| (station.share, station.arc))
        .collect()
}

/// What is left at a place: nothing is gone before the program begins, at its end it is what the forces leave behind, and on the way
/// there is material before the tool and none behind it; forwards and backwards.
#[test]
fn the_stock_along_a_program_is_what_it_leaves() {
    let text = format!("{START}G0 Y10\nG1 Z-2 F600\nG1 X30\nG2 X40 Y20 I0 J10\nG1 X40 Y40\nM2\n");
    let path = path(&text);
    let source = block([0.0, 0.0, -5.0], [50.0, 30.0, 0.0]);
    let question = question(source);
    let (_, left) = question.along_and_left(&path, &Unwatched).unwrap();
    let left = left.unwrap();
    let tops = |stock: &Stock| {
        let places =
            (0..50).flat_map(|i| (0..30).map(move |j| [0.5 + f64::from(i), 0.5 + f64::from(j)]));
        places
            .map(|[x, y]| stock.top_mm(x, y).unwrap_or(f64::NEG_INFINITY))
            .collect::<Vec<f64>>()
    };
    let mut along = StockAlong::of(&question, &path).unwrap();
    assert!(
        tops(&along.at(0, 0.0).unwrap())
            .iter()
            .all(|top| *top == 0.0)
    );
    let at_end = tops(&along.at(path.moves.len(), 0.0).unwrap());
    let cut = at_end.iter().filter(|top| **top < -1.9).count();
    assert!(cut > 100, "{cut}");
    for (own, wanted) in at_end.iter().zip(tops(&left)) {
        assert!((own - wanted).abs() < 1e-6, "{own} {wanted}");
    }
    // Half of the slot along x, which runs from -10 to 30.
    let slot = path.moves.iter().position(|m| m.end.x == 30.0).unwrap();
    let half = along.at(slot, 0.5).unwrap();
    assert!((half.top_mm(5.0, 10.0).unwrap() + 2.0).abs() < 1e-6);
    assert_eq!(half.top_mm(20.0, 10.0), Some(0.0));
    let mut anew = StockAlong::of(&question, &path).unwrap();
    assert_eq!(tops(&anew.at(slot, 0.5).unwrap()), tops(&half));
    let stated = EngagementSource::Constant(Engagement::air());
    assert!(
        StockAlong::of(
            &CutQuestion {
                engagement: stated,
                ..question
            },
            &path
        )
        .is_none()
    );
}
