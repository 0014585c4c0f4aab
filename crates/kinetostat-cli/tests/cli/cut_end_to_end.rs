//! Real programs cut out of a block of aluminium, from the file to the file: what is written is read again and solved again,
//! and where the tool meets nothing, nothing is corrected but the machine's own weight.
//!
//! The first blocks of each program: all 40 000 take 20 s in a release.

#![allow(clippy::unwrap_used, reason = "a failing test may panic")]

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use kinetostat::{Pose, Wrench};
use kinetostat_cutting::{Materials, Rotation, Shape, Stock, StockSettings, Tool};
use kinetostat_machining::{
    CutQuestion, CuttingTool, EngagementSource, ForceAlongPath, ForceChoice, Unwatched,
    straight_tool,
};
use kinetostat_model::Model;
use kinetostat_program::{Program, ReadOptions, Units, interpret};
use kinetostat_testing::Worst;
use nalgebra::{Rotation3, UnitQuaternion, Vector3};

use crate::common::{gcode, run};

/// Lines of a program that are cut.
const LINES: usize = 600;
/// Diameter of the tool, mm.
const DIAMETER: f64 = 6.0;

/// A machine with its tool and where it has the part, m; how the tool stands.
struct Machine {
    name: &'static str,
    tool_mm: f64,
    /// For the pocket and for the part.
    origins_mm: [[f64; 3]; 2],
    turned: UnitQuaternion<f64>,
}

fn machines() -> [Machine; 2] {
    [
        Machine {
            name: "orthoglide",
            tool_mm: 0.0,
            origins_mm: [[-70.0, 70.0, 100.0], [-100.0, -100.0, 100.0]],
            turned: UnitQuaternion::identity(),
        },
        // It stands before its base, the tool down; it carries its own weight.
        Machine {
            name: "heavy_6r",
            tool_mm: 150.0,
            origins_mm: [[1050.0, 0.0, 1000.0]; 2],
            turned: UnitQuaternion::from_axis_angle(&Vector3::y_axis(), std::f64::consts::PI),
        },
    ]
}

/// Two corners, mm.
type Block = [[f64; 3]; 2];

/// File, corners of the whole block, and of a block under half of what the first lines cut, mm.
const PROGRAMS: [(&str, Block, Block); 2] = [
    (
        "tball-pocket.gcode",
        [[-5.0, -140.0, -12.0], [140.0, 5.0, 0.0]],
        [[-5.0, -140.0, -12.0], [75.0, 5.0, 0.0]],
    ),
    // Layers of a part: the lowest ones cut.
    (
        "part.gcode",
        [[70.0, 70.0, -2.0], [130.0, 130.0, 0.6]],
        [[70.0, 70.0, -2.0], [100.0, 130.0, 0.6]],
    ),
];

/// Text of the first lines; none where the shared data are not there.
fn first_lines(name: &str) -> Option<String> {
    let text = std::fs::read_to_string(gcode()?.join(name)).unwrap();
    Some(text.split_inclusive('\n').take(LINES).collect())
}

fn job(machine: &Machine, origin: [f64; 3], block: Block) -> String {
    format!(
        r#"schema = 1
model = "{}"
program = "given.ngc"
[reading]
units = "mm"
[placement]
part_origin_mm = {origin:?}
[tool]
length_mm = {:?}
cutter = {{ shape = "flat", diameter_mm = {DIAMETER:?}, teeth = 2, helix_deg = 30 }}
[load]
weight = "all"
[material]
name = "AlMg4.5Mn"
[stock]
block_mm = {block:?}
[spindle]
rpm = 12000
rotation = "clockwise"
[output]
program = "out.ngc"
json = "result.json"
points = "points.csv"
"#,
        machine.name, machine.tool_mm
    )
}

/// A place of the path: lines, share of the move, where the tool should be (mm), force on it (N).
struct Place {
    line: usize,
    output_line: usize,
    share: f64,
    wanted: Vector3<f64>,
    force: Vector3<f64>,
}

fn places(here: &Path) -> Vec<Place> {
    let mut reader = csv::Reader::from_path(here.join("points.csv")).unwrap();
    let heads = reader.headers().unwrap().clone();
    let column = |name: &str| heads.iter().position(|head| head == name).unwrap();
    let columns = [
        "line",
        "output_line",
        "share",
        "x_mm",
        "y_mm",
        "z_mm",
        "force_x_n",
        "force_y_n",
        "force_z_n",
    ]
    .map(column);
    let rows = reader.records().map(|row| {
        let row = row.unwrap();
        let n = columns.map(|i| row[i].parse::<f64>().unwrap());
        Place {
            line: n[0] as usize,
            output_line: n[1] as usize,
            share: n[2],
            wanted: Vector3::new(n[3], n[4], n[5]),
            force: Vector3::new(n[6], n[7], n[8]),
        }
    });
    rows.collect()
}

fn path_of(file: &Path) -> kinetostat_program::Path {
    let mut options = ReadOptions::default();
    options.units = Some(Units::Millimetres);
    let program = Program::read(std::fs::read(file).unwrap()).unwrap();
    interpret(&program, &options).unwrap()
}

/// Ends of the moves of the written program by their lines, mm: from its bytes, by the reader.
fn written_ends(here: &Path) -> BTreeMap<usize, Vector3<f64>> {
    let path = path_of(&here.join("out.ngc"));
    path.moves.iter().map(|m| (m.line, m.end)).collect()
}

/// Wrenches of the cut, in axes of the feed: points of a run have the force and not its moment about the tip.
struct Moments {
    along: ForceAlongPath,
    /// Number of the last move of a line.
    moves: BTreeMap<usize, usize>,
}

impl Moments {
    fn new(here: &Path, [from, to]: Block) -> Self {
        let tool = Tool::new(Shape::Flat, DIAMETER, 2).unwrap();
        let tool = tool.with_helix(30_f64.to_radians()).unwrap();
        let stock = Stock::block(from, to, &StockSettings::for_tool(&tool)).unwrap();
        let material = Materials::library().find("AlMg4.5Mn").unwrap().clone();
        let question = CutQuestion {
            tools: vec![CuttingTool::new(tool, Arc::new(material))],
            engagement: EngagementSource::Stock(Box::new(stock)),
            choice: ForceChoice::Mean,
            rpm: Some(12_000.0),
            rotation: Some(Rotation::Clockwise),
            spindle: None,
        };
        let path = path_of(&here.join("given.ngc"));
        let moves = path.moves.iter().enumerate().map(|(k, m)| (m.line, k));
        Self {
            moves: moves.collect(),
            along: question.along(&path, &Unwatched).unwrap(),
        }
    }

    /// The force of a place with its moment: that of the cut, turned and made as large as the force is. None where the load
    /// only comes or goes beside a cut.
    fn wrench(&self, place: &Place) -> Option<Wrench> {
        if place.force.norm() == 0.0 {
            return Some(Wrench::zero());
        }
        let cut = self.along.wrench(self.moves[&place.line], 1.0);
        let (f, m) = (cut.force(), cut.moment());
        if f.xy().norm() < 1e-3 * f.norm() || f.norm() == 0.0 {
            return None;
        }
        let heading = place.force.y.atan2(place.force.x) - f.y.atan2(f.x);
        let turned = Rotation3::from_axis_angle(&Vector3::z_axis(), heading) * m;
        let share = place.force.norm() / f.norm();
        Some(Wrench::new(place.force, share * turned))
    }
}

fn result(here: &Path) -> serde_json::Value {
    serde_json::from_slice(&std::fs::read(here.join("result.json")).unwrap()).unwrap()
}

/// Ends of blocks at which the machine, commanded as the written program says and loaded by the force there, is put off the
/// given path: how far, mm, in the cut and in the air.
fn solved_again(here: &Path, machine: &Machine, origin: [f64; 3], block: Block) -> (Worst, Worst) {
    let moments = Moments::new(here, block);
    let model = Model::preset(machine.name).unwrap();
    let mechanism = model
        .mechanism
        .with_tool(&straight_tool(1e-3 * machine.tool_mm));
    let ends = written_ends(here);
    let (mut cut, mut air) = (Worst::new(), Worst::new());
    let all = places(here);
    let last: Vec<&Place> = all.iter().filter(|place| place.share == 1.0).collect();
    for place in last.iter().step_by(7) {
        let Some(wrench) = moments.wrench(place) else {
            continue;
        };
        let at = |mm: &Vector3<f64>| 1e-3 * (Vector3::from(origin) + mm);
        let commanded = Pose::from_parts(at(&ends[&place.output_line]).into(), machine.turned);
        let loaded = mechanism
            .posture(&commanded)
            .unwrap()
            .deflected_by(&wrench)
            .unwrap();
        let off = 1e3 * (loaded.tool.translation.vector - at(&place.wanted)).norm();
        let which = match place.force.norm() > 0.0 {
            true => &mut cut,
            false => &mut air,
        };
        which.add_at(off, || format!("line {}", place.line));
    }
    (cut, air)
}

/// Runs the command in a directory of its own.
fn compensated(machine: &Machine, origin: [f64; 3], block: Block, text: &str) -> tempfile::TempDir {
    let here = tempfile::tempdir().unwrap();
    std::fs::write(here.path().join("given.ngc"), text).unwrap();
    std::fs::write(here.path().join("job.toml"), job(machine, origin, block)).unwrap();
    run(here.path(), &["compensate", "job.toml"]).answered();
    here
}

#[test]
fn real_programs_are_where_they_should_be_under_their_cut() {
    for (k, (name, block, _)) in PROGRAMS.into_iter().enumerate() {
        let Some(text) = first_lines(name) else {
            return;
        };
        for machine in machines() {
            let origin = machine.origins_mm[k];
            let here = compensated(&machine, origin, block, &text);
            let case = format!("{name} on {}", machine.name);
            let result = result(here.path());
            assert_eq!(
                result["tolerance"]["held"], true,
                "{case}: {}",
                result["tolerance"]
            );
            let allowed = result["tolerance"]["allowed_mm"].as_f64().unwrap();
            let before = result["summary"]["max_position_error_before_mm"]
                .as_f64()
                .unwrap();
            assert!(before > 10.0 * allowed, "{case}: {before}");
            let (cut, air) = solved_again(here.path(), &machine, origin, block);
            println!(
                "{case}: allowed {allowed}, before {before}, in the cut {cut}, in the air {air}"
            );
            assert!(cut.samples() > 20, "{case}: {}", cut.samples());
            assert!(cut.holds(allowed), "{case}: {cut}");
            assert!(air.samples() == 0 || air.holds(allowed), "{case}: {air}");
        }
    }
}

/// Moves that lie more than the tool's radius and a millimetre beside the block, for x above: how many, and those whose line is
/// not written as it was. None of them bears a force.
fn kept_in_air(here: &Path, text: &str, block_ends_at: f64) -> (usize, Vec<String>) {
    let given: Vec<&str> = text.lines().collect();
    let out = std::fs::read_to_string(here.join("out.ngc")).unwrap();
    let out: Vec<&str> = out.lines().collect();
    let free = block_ends_at + 0.5 * DIAMETER + 1.0;
    let mut moves: BTreeMap<usize, Vec<Place>> = BTreeMap::new();
    for place in places(here) {
        moves.entry(place.line).or_default().push(place);
    }
    let (mut compared, mut unlike, mut came_from) = (0, Vec::new(), f64::MIN);
    for (line, places) in moves {
        let beside = came_from > free && places.iter().all(|place| place.wanted.x > free);
        came_from = places.last().unwrap().wanted.x;
        if !beside {
            continue;
        }
        compared += 1;
        for place in places {
            assert_eq!(place.force.norm(), 0.0, "line {line}");
            let (was, is) = (given[line - 1], out[place.output_line - 1]);
            if was != is {
                unlike.push(format!("line {line}: {was} is {is}"));
            }
        }
    }
    (compared, unlike)
}

/// Half of the block is not there: beyond it the Orthoglide's program is as it was, byte by byte, and the arm's has nothing but
/// what its weight asks for.
#[test]
fn where_half_of_the_block_is_missing_nothing_is_corrected_for_a_cut() {
    for (k, (name, _, half)) in PROGRAMS.into_iter().enumerate() {
        let Some(text) = first_lines(name) else {
            return;
        };
        for machine in machines() {
            let origin = machine.origins_mm[k];
            let here = compensated(&machine, origin, half, &text);
            let case = format!("{name} on {}", machine.name);
            let allowed = result(here.path())["tolerance"]["allowed_mm"]
                .as_f64()
                .unwrap();
            let (cut, air) = solved_again(here.path(), &machine, origin, half);
            println!("{case}: in the cut {cut}, in the air {air}");
            assert!(
                cut.samples() > 5 && air.samples() > 5,
                "{case}: {} {}",
                cut.samples(),
                air.samples()
            );
            assert!(air.holds(allowed), "{case}: {air}");
            let (compared, unlike) = kept_in_air(here.path(), &text, half[1][0]);
            assert!(compared > 50, "{case}: {compared}");
            if machine.name == "orthoglide" {
                assert_eq!(unlike, Vec::<String>::new(), "{case}");
            }
        }
    }
}
