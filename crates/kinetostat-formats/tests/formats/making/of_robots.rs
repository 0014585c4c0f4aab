//! From the language of one robot to that of another.

use kinetostat_formats::*;
use kinetostat_testing::Worst;
use nalgebra::Vector3;

use super::{ROBOTS, read_made, text_of};

const RAPID: &str = "MODULE M\nPERS wobjdata table:=[FALSE,TRUE,\"\",[[500,0,300],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];\nPROC main()\n\
    MoveJ [[0,0,50],[0.02,0.8,-0.59,0.1],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,z10,tool0\\WObj:=table;\n\
    SetDO doSpindle,1;\n! groove\n\
    MoveL [[0,0,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,z1,tool0\\WObj:=table;\n\
    MoveC [[5,5,0],[0,0.9961947,0,0.0871557],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],\
    [[10,0,0],[0,0.9848078,0,0.1736482],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,fine,tool0\\WObj:=table;\nENDPROC\nENDMODULE\n";

#[test]
fn a_program_of_abb_runs_on_others() {
    let text = RAPID.replace("[0.02,0.8,-0.59,0.1]", "[0,0.8,-0.6,0]");
    let program = read_rapid(
        vec![SourceFile::new("m.mod", text)],
        &ReadOptions::default(),
    )
    .unwrap();
    let robot = path_of(&program, &PathOptions::default()).unwrap();
    let mut template = Template::default();
    template.base.pose = robot
        .work_object
        .as_ref()
        .and_then(|frame| frame.known().copied());
    for (into, language) in ROBOTS {
        let made = make(&robot.path, &events_of_robot(&program), &template, into).unwrap();
        assert!(
            made.kept.orientation_rad < 1e-9 && made.kept.position_mm < 1e-6,
            "{into:?} {:?}",
            made.kept
        );
        let again = read_made(&made, language);
        assert_eq!(again.motions.len(), 3);
        let (mut places, mut turns) = (Worst::default(), Worst::default());
        for (one, other) in program.motions.iter().zip(&again.motions) {
            let [one, other] = [one, other].map(|motion| motion.target.pose().unwrap());
            places.add((one.position_mm - other.position_mm).norm());
            turns.add(one.orientation.angle_to(&other.orientation));
        }
        assert!(places.value() < 1e-6 && turns.value() < 3e-8);
        let MotionKind::Circular { via } = &again.motions[2].kind else {
            panic!("{:?}", again.motions[2]);
        };
        assert!((via.pose().unwrap().position_mm - Vector3::new(5.0, 5.0, 0.0)).norm() < 1e-6);
        let text = text_of(&made, 0);
        assert!(
            text.contains("line 5: SetDO doSpindle,1") && text.contains("line 6: ! groove"),
            "{text}"
        );
        assert!(
            made.findings
                .iter()
                .any(|f| f.message.starts_with("other statements: 1 lines"))
        );
    }
}
