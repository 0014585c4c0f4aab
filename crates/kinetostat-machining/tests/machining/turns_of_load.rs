//! In which direction a load of the feed acts while rotary axes turn alone: put together by hand, and the same however the turn is divided.

use kinetostat_machining::{CuttingLoad, LoadAlongPath, ProgramLoad};
use kinetostat_program::{Program, interpret};
use kinetostat_testing::Worst;
use nalgebra::Vector3;

use crate::five_axes::Machine;

const BEFORE: &str =
    "G21 G90 G94\nG0 A0 C0\nG0 X0 Y0 Z40\nG43.4 H1 Z40\nG0 A20 C-20\nG1 Z0 F600\nX20\n";
const BEHIND: &str = "X40 F600\nG0 Z50\nG49\nM30\n";

#[test]
fn the_feed_of_a_turn_in_place_is_fixed_in_the_part() {
    let machine = Machine::head_and_table();
    let load = ProgramLoad::new(CuttingLoad::Milling {
        radial: 400.0,
        tangential: -150.0,
        axial: -80.0,
    });
    let mut worst = Worst::new();
    let mut count = 0;
    for turns in [&[70.0][..], &[5.0, 70.0], &[-10.0, 25.0, 70.0]] {
        let words: Vec<String> = turns.iter().map(|c| format!("C{c} F900\n")).collect();
        let text = format!("{BEFORE}{}{BEHIND}", words.concat());
        let program = Program::read(text).unwrap();
        let path = interpret(&program, &machine.options()).unwrap();
        let along = LoadAlongPath::new(load, &path);
        let in_place = path.moves.iter().enumerate();
        for (index, motion) in in_place.filter(|(_, motion)| motion.turns_in_place()) {
            if motion.line < 8 {
                continue;
            }
            for step in 0..=10 {
                let share = f64::from(step) / 10.0;
                // The path around goes along x of the part.
                let tool = path.tool_direction(index, share);
                let feed = (Vector3::x() - tool * tool.x).normalize();
                let force = feed.cross(&tool) * 400.0 - feed * 150.0 - tool * 80.0;
                let part = motion.part_turn(share).unwrap().rotation;
                let wanted = machine.placement.base_from_part.rotation * (part * force);
                let is = along.wrench(&machine.placement, index, share);
                worst.add((is.force() - wanted).norm());
                count += 1;
            }
        }
    }
    assert_eq!(count, 66);
    assert!(worst.of(count) < 1e-6, "{}", worst.of(count));
}
