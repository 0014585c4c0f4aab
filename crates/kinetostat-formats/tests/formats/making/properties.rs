//! Random paths of lines, arcs and helices in all planes: made in every language, read again, compared; every other text is
//! refused by a line or made, without a panic.

use kinetostat_formats::*;
use kinetostat_program::{Program, ReadOptions as Reading, interpret};
use kinetostat_testing::Worst;
use kinetostat_testing::figure::at_most;

use super::{ROBOTS, cell};
use crate::harness::Chance;

/// A program of so many moves, all of which are known.
fn random(chance: &mut Chance, moves: usize) -> String {
    let mut text = String::from("G21 G90 G17\nG0 X0 Y0 Z0\n");
    for _ in 0..moves {
        let [x, y, z] = [300.0, 300.0, 50.0].map(|size| chance.within(size));
        let feed = 6.0 * (1 + chance.below(400)) as f64;
        text += &match chance.below(7) {
            0 => format!("G0 X{x:.4} Y{y:.4} Z{z:.4}\n"),
            1 => format!("G1 X{x:.4} Y{y:.4} Z{z:.4} F{feed}\n"),
            // A half or more, with its centre beside the start.
            2 => format!(
                "G91 G{} X{:.4} Y{:.4} I{:.4} J{:.4} F{feed}\nG90\n",
                2 + chance.below(2),
                x / 5.0,
                y / 5.0,
                x / 10.0,
                y / 10.0
            ),
            3 => format!("G91 G3 I{:.4} J{:.4} F{feed}\nG90\n", x / 9.0, y / 9.0),
            4 => format!(
                "G91 G2 I{:.4} J{:.4} Z{:.4} F{feed}\nG90\n",
                x / 90.0,
                y / 90.0,
                z / 9.0
            ),
            5 => format!(
                "G91 G18 G3 I{:.4} K{:.4} F{feed}\nG17 G90\n",
                x / 9.0,
                z / 9.0
            ),
            _ => format!("M{} (line)\nS{feed}\n", chance.below(10)),
        };
    }
    text
}

#[test]
fn figure_random_paths_are_kept() {
    let mut done = 0;
    let (mut away, mut turned) = (Worst::new(), Worst::new());
    for seed in 0..100 {
        let mut chance = Chance::new(seed);
        let text = random(&mut chance, 30);
        let Ok(program) = Program::read(text.clone()) else {
            continue;
        };
        let Ok(path) = interpret(&program, &Reading::default()) else {
            continue;
        };
        let events = events_of_gcode(&program, &path);
        let mut template = cell();
        template.tolerance_mm = 0.01;
        template.most_points = Some(7 + chance.below(300));
        for (into, _) in ROBOTS {
            let made = make(&path, &events, &template, into);
            let made = made.unwrap_or_else(|all| panic!("{seed} {into:?}: {}\n{text}", all[0]));
            assert!(
                made.kept.position_mm < 1e-6 && made.kept.orientation_rad < 1e-9,
                "{seed} {into:?} {:?}",
                made.kept
            );
            away.add(made.kept.position_mm);
            turned.add(made.kept.orientation_rad);
            assert!(
                made.kept.chord_mm < 0.0101 && made.kept.arc_mm < 1e-2,
                "{seed} {into:?} {:?}",
                made.kept
            );
        }
        for into in [MakeLanguage::Apt, MakeLanguage::Csv, MakeLanguage::Gcode] {
            let made = make(&path, &events, &template, into);
            let made = made.unwrap_or_else(|all| panic!("{seed} {into:?}: {}\n{text}", all[0]));
            assert!(
                made.kept.position_mm < 1e-6 && made.kept.speed_relative < 1e-8,
                "{seed} {into:?} {:?}",
                made.kept
            );
            away.add(made.kept.position_mm);
        }
        done += 1;
    }
    assert!(done > 50, "{done}");
    let name = "converted programs, read again: places beside those of the path";
    assert!(at_most(name, away.value(), 1e-6, "mm"), "{away:?}");
    let name = "converted programs, read again: orientations beside those of the path";
    assert!(at_most(name, turned.value(), 1e-9, "rad"), "{turned:?}");
}
