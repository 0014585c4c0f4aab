//! Corrected places, further rows, turned tools, changed speeds.

use kinetostat_formats::*;
use nalgebra::{UnitQuaternion, Vector3};

use super::{RASTERS, TABLE, place, program, written};

#[test]
fn only_the_numbers_change() {
    let table = program("a.csv", TABLE);
    let output = written(&table, &[Piece::to(2, Vector3::new(60.0123, 0.0, -0.98))]);
    let wanted = "along, 60.012,0,-0.980,0,0,1,0,20,0,tMill,wPart,9E9,\"\"";
    let line = "along, 60.00,0,-1,0,0,1,0,20,0,tMill,wPart,9E9,\"\"";
    assert_eq!(output, TABLE.replace(line, wanted));
    // Half a micrometre in metres: six decimals, or as many as there were; plus signs and bare points as before.
    let rasters = program("a.yaml", RASTERS);
    let pieces = [
        Piece::to(0, Vector3::new(100.0, 250.2, -20.0)),
        Piece::to(2, Vector3::new(200.0, 350.1, -20.3)),
    ];
    let output = written(&rasters, &pieces);
    let wanted = RASTERS
        .replace("y: 0.25   # measured", "y: 0.250200   # measured")
        .replace("y: .35", "y: .350100")
        .replace("z: -2e-2", "z: -0.020300");
    assert_eq!(output, wanted);
}

/// Anchors and tags stand before the bracket of a map: its end is that of the bracket all the same.
#[test]
fn a_map_with_an_anchor_or_a_tag_is_copied_whole() {
    for own in ["&a ", "!!map ", "&a !!map "] {
        let pose = |x: u8| {
            format!(
                "- orientation: {own}{{w: 1, x: 0, y: 0, z: 0}}\n  position: {own}{{x_mm: {x}, y_mm: 0, z_mm: 5}}\n"
            )
        };
        let poses = program("a.yaml", &[pose(0), pose(8)].concat());
        let pieces = [
            Piece::to(1, Vector3::new(4.0, 1.0, 5.0)),
            Piece::to(1, Vector3::new(8.0, 0.0, 5.0)),
        ];
        let output = written(&poses, &pieces);
        let again = program("a.yaml", &output);
        assert_eq!(again.motions.len(), 3, "{output}");
        assert_eq!(place(&again, 1), [4.0, 1.0, 5.0]);
    }
}

#[test]
fn a_pose_that_becomes_several_is_written_with_its_own_layout() {
    let rasters = program("a.yaml", RASTERS);
    let halves = |motion: usize, middle: Vector3<f64>| {
        let end = Vector3::from(place(&rasters, motion));
        [Piece::to(motion, middle), Piece::to(motion, end)]
    };
    let output = written(&rasters, &halves(1, Vector3::new(100.0, 275.0, -20.1)));
    let own = "        - orientation: {w: 0, x: 0, y: 1, z: 0}\n          position: {z: -0.02, y: 0.30, x: 0.1}\n          dwell: 0\n";
    let copy = own
        .replace("-0.02,", "-0.020100,")
        .replace("0.30,", "0.275000,");
    assert_eq!(output, RASTERS.replace(own, &[&copy, own].concat()));
    // The first pose of a raster is a joint motion.
    let refused = write(
        &rasters,
        &halves(2, Vector3::zeros()),
        &WriteOptions::default(),
    );
    let said = refused.unwrap_err().to_string();
    assert!(
        said.contains("line 21: a joint motion cannot be divided"),
        "{said}"
    );
    let table = program("a.csv", &TABLE.replace('\n', "\r\n"));
    let pieces = [
        Piece::to(2, Vector3::new(30.0, 0.01, -1.0)),
        Piece::to(2, Vector3::new(60.0, 0.0, -1.0)),
    ];
    let output = written(&table, &pieces);
    let wanted = "along, 30.000,0.010,-1,0,0,1,0,20,0,tMill,wPart,9E9,\"\"\r\nalong, 60.00,0,-1,";
    assert!(output.contains(wanted), "{output}");
}

#[test]
fn speeds_change_where_they_are_written_in_mm_per_s() {
    let names = "speed_mm_per_s,x_mm,y_mm,z_mm\n";
    let order = "x_mm,speed_mm_per_s,y_mm,z_mm\n";
    for (text, wanted) in [
        (
            format!("{names}1,2,3,4\n20,5,3,4\n"),
            "1,2,3,4\n25,3.500,3,4\n30,5,3,4\n",
        ),
        (
            format!("{order}2,1,3,4\n5,20,3,4\n"),
            "2,1,3,4\n3.500,25,3,4\n5,30,3,4\n",
        ),
    ] {
        let program = program("a.csv", &text);
        let mut pieces = [
            Piece::to(1, Vector3::new(3.5, 3.0, 4.0)),
            Piece::to(1, Vector3::new(5.0, 3.0, 4.0)),
        ];
        pieces[0].speed_factor = 1.25;
        pieces[1].speed_factor = 1.5;
        let output = written(&program, &pieces);
        assert_eq!(output.split_once('\n').unwrap().1, wanted);
    }
    let text = "x_mm,y_mm,z_mm,feed_mm_per_min\n2,3,4,600\n5,3,4,600\n";
    let program = program("a.csv", text);
    assert!((program.motions[1].speed.mm_per_s.unwrap() - 10.0).abs() < 1e-12);
    let mut piece = Piece::to(1, Vector3::new(5.0, 3.0, 4.0));
    piece.speed_factor = 1.5;
    let error = write(&program, &[piece], &WriteOptions::default()).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("line 3: its speed cannot be changed")
    );
}

#[test]
fn orientations_keep_their_convention_and_sign() {
    let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), 1e-3);
    for text in [
        "x_mm,y_mm,z_mm,qw,qx,qy,qz\n1,2,3,0,0,-1,0\n",
        "x_mm,y_mm,z_mm,rx_deg,ry_deg,rz_deg\n1,2,3,180,0,10\n",
        "x_mm,y_mm,z_mm,a_deg,b_deg,c_deg\n1,2,3,10,0,180\n",
        "x_mm,y_mm,z_mm,i,j,k\n1,2,3,0.6,0,0.8\n",
    ] {
        let program = program("a.csv", text);
        let pose = program.motions[0].target.pose().unwrap();
        let mut piece = Piece::to(0, pose.position_mm);
        piece.orientation = Some(turn * pose.orientation);
        let output = written(&program, &[piece.clone()]);
        let again = super::program("a.csv", &output);
        let found = again.motions[0].target.pose().unwrap().orientation;
        let off = match text.contains("i,j,k") {
            true => (found * Vector3::z() - piece.orientation.unwrap() * Vector3::z()).norm(),
            false => found.angle_to(&piece.orientation.unwrap()),
        };
        assert!(off < 4e-7, "{output}: {off}");
        assert!(
            !text.contains("-1") || output.contains("-1.0000") || output.contains("-0.99999"),
            "{output}"
        );
    }
    let bare = program("a.csv", "x_mm,y_mm,z_mm\n1,2,3\n");
    let mut piece = Piece::to(0, Vector3::new(1.0, 2.0, 3.0));
    piece.orientation = Some(turn);
    let error = write(&bare, &[piece], &WriteOptions::default()).unwrap_err();
    assert!(
        error.to_string().contains("states no orientation"),
        "{error}"
    );
}

#[test]
fn a_key_without_a_value_is_copied_with_its_colon() {
    for end in ["  note:\n", "  note :\n  # behind\n", "  note:"] {
        let first = format!("- position: {{x_mm: 0, y_mm: 0, z_mm: 5}}\n{end}\n");
        let text = format!("{first}- position: {{x_mm: 8, y_mm: 0, z_mm: 5}}\n{end}");
        let poses = program("a.yaml", &text);
        let pieces = [
            Piece::to(1, Vector3::new(4.0, 1.0, 5.0)),
            Piece::to(1, Vector3::new(8.0, 0.0, 5.0)),
        ];
        let output = written(&poses, &pieces);
        let again = program("a.yaml", &output);
        assert_eq!(again.motions.len(), 3, "{output}");
        assert_eq!(place(&again, 1), [4.0, 1.0, 5.0]);
        assert_eq!(output.matches("note").count(), 3, "{output}");
    }
}
