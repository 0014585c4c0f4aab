//! A program of Universal Robots through the commands: compensated, verified, and changed by somebody else.

use crate::verify_robot::{LOADED, POSE, changes};

const PART: &str = "def part():
  set_tcp(p[0, 0, 0.15, 0, 0, 0])
  set_payload(2.5, [0, 0, 0.05])
  global table=p[1.3, 0.05, 0.9, 0, 0, 0]
  movel(pose_trans(table, p[0, 0, 0.03, 3.14159265359, 0, 0]), v=0.2)
  movel(pose_trans(table, p[0, 0, 0, 3.14159265359, 0, 0]), v=0.02)
  movel(pose_trans(table, p[0.12, 0, 0, 3.14159265359, 0, 0]), a=1.2, v=0.02) # along
  movec(pose_trans(table, p[0.14, 0.02, 0, 3.14159265359, 0, 0]), pose_trans(table, p[0.12, 0.04, 0, 3.14159265359, 0, 0]), v=0.02)
  movel(pose_trans(table, p[0.12, 0.04, 0.03, 3.14159265359, 0, 0]), v=0.2)
end
";

#[test]
fn a_program_is_compensated_and_verified_and_frames_are_those_of_the_original() {
    changes(
        "part.script",
        PART,
        &format!("{LOADED}{POSE}"),
        &[
            (
                "table=p[1.3,",
                "table=p[1.0,",
                3,
                "it is at (1000, 50, 900) mm",
            ),
            (
                "set_tcp(p[0, 0, 0.15,",
                "set_tcp(p[0, 0, 0.151,",
                3,
                "it is at (0, 0, 151) mm",
            ),
            (
                "a=1.2",
                "a=2.5",
                3,
                "with ACCELERATION 2.5, the original with ACCELERATION 1.2",
            ),
            ("movel(", "movep(", 3, "with a process motion"),
            (
                "def part():",
                "while True:\n  part()\nend\ndef part():",
                3,
                "A LOOP WITHOUT END at line",
            ),
        ],
    );
}
