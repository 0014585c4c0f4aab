//! Compensated programs of arms against Pinocchio: where the real, elastic arm has its tool when a controller runs
//! the program that was written.
//!
//! The script `validation/scripts/robot_program_pinocchio.py` shares nothing with the command but files: it reads the programs
//! itself, interpolates as the controller does, and finds commands, deflection and weight with Pinocchio.

#![allow(clippy::unwrap_used, reason = "a failing test may panic")]
#![allow(clippy::print_stdout)] // what is skipped

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use serde_json::{Value, json};

use crate::common::chains::figure;
use crate::common::run;

/// A line, an arc and a line; the tool turns by more than 10 degrees about several axes on each.
const KRL: &str = "DEF part ( )
$ORI_TYPE=#VAR
$TOOL={TOOL}
$BASE={X ORIGIN,A 20,B 0,C 0}
$VEL.CP=0.02
PTP {X 0,Y 0,Z 50,A 0,B 84,C 3}
LIN {X 0,Y 0,Z 0,A 0,B 84,C 3}
LIN {X 120,Y 40,Z -5,A 14,B 78,C -10}
CIRC {X 160,Y 60,Z 0,A 16,B 80,C -6},{X 170,Y 110,Z 10,A 20,B 83,C -4}
LIN {X 20,Y 120,Z 0,A -6,B 88,C 12}
END
";

/// The same poses; here z of the tool lies where x does in KRL.
const RAPID: &str = r#"MODULE Part
  PERS tooldata tMill:=[TRUE,[[12,-8,180],[1,0,0,0]],[5,[0,0,60],[1,0,0,0],0,0,0]];
  PERS wobjdata wPart:=[FALSE,TRUE,"",[[ORIGIN],[0.98480775,0,0,0.17364818]],[[0,0,0],[1,0,0,0]]];
  CONST robtarget pIn:=[[0,0,0],[0.05231802,0.02614107,0.99828733,0.00137000],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    MoveJ [[0,0,50],[0.05231802,0.02614107,0.99828733,0.00137000],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,z10,tMill\WObj:=wPart;
    MoveL pIn,v20,fine,tMill\WObj:=wPart;
    MoveL [[120,40,-5],[0.10446479,-0.20677273,0.97278921,0.00364799],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,z1,tMill\WObj:=wPart;
    CirPathMode\ObjectFrame;
    MoveC [[160,60,0],[0.08682409,-0.19008291,0.97789180,0.00759612],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],[[170,110,10],[0.06045442,-0.20752389,0.97632316,0.00849631],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,z1,tMill\WObj:=wPart;
    MoveL [[20,120,0],[0.01742849,0.15641064,0.98753791,0.00091339],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,fine,tMill\WObj:=wPart;
  ENDPROC
ENDMODULE
"#;

/// The places of these poses, mm.
const PLACES: [&str; 6] = [
    "0, 0, 50",
    "0, 0, 0",
    "120, 40, -5",
    "160, 60, 0",
    "170, 110, 10",
    "20, 120, 0",
];

/// How the tool stands there in RAPID: W, P, R of FANUC, rotation vectors of Universal Robots (rad), rx, ry, rz of Staubli.
const TURNS: [[&str; 3]; 5] = [
    [
        "179.68483, 5.99175, 176.98351",
        "0.07949692, 3.03586529, 0.00416627",
        "-180, 6, -177",
    ],
    [
        "-177.88617, 11.81504, -155.78125",
        "-0.60965144, 2.86818452, 0.01075578",
        "-177.05632, 11.63848, 155.69993",
    ],
    [
        "-178.94409, 9.94466, -157.90813",
        "-0.56625227, 2.91311539, 0.02262865",
        "-177.21748, 9.60887, 157.76608",
    ],
    [
        "-179.50927, 6.98286, -155.97006",
        "-0.62799738, 2.95449543, 0.02571107",
        "-177.59529, 6.57592, 155.86183",
    ],
    [
        "179.58401, 1.95628, 161.9929",
        "0.48600006, 3.06848358, 0.00283809",
        "179.79086, 1.98904, -161.99637",
    ],
];

/// `PR[8]` and `PR[9]`, which are the frame and the tool, stand before it; the positions behind it.
const TP: &str = "  UFRAME[1]=PR[8] ;
  UTOOL[1]=PR[9] ;
  UFRAME_NUM=1 ;
  UTOOL_NUM=1 ;
J P[1] 10% FINE ;
L P[2] 20mm/sec FINE ;
L P[3] 20mm/sec FINE ;
C P[4]
    :  P[5] 20mm/sec FINE ;
L P[6] 20mm/sec FINE ;
";

/// Poses stand for P1 to P6.
const URSCRIPT: &str = "def part():
  set_tcp(p[0.012, -0.008, 0.18, 0, 0, 0])
  global table = p[1.5, 0.1, 0.7, 0, 0, 0.34906585]
  movej(get_inverse_kin(P1), a=1.4, v=1.05)
  movel(P2, a=1.2, v=0.02)
  movel(P3, a=1.2, v=0.02)
  movec(P4, P5, a=1.2, v=0.02)
  movel(P6, a=1.2, v=0.02)
end
";

const VAL3: &str = r#"<Programs>
  <Program name="part">
    <Code><![CDATA[begin
  movej(p1,tMill,mCut)
  movel(p2,tMill,mCut)
  movel(p3,tMill,mCut)
  movec(p4,p5,tMill,mCut)
  movel(p6,tMill,mCut)
end]]></Code>
  </Program>
</Programs>
"#;

/// Of the drives of an imported arm, N m/rad.
const STIFFNESS: [f64; 6] = [3.8e6, 6.6e6, 3.9e6, 5.6e5, 6.6e5, 4.7e5];

/// A force and a moment off all axes, N and N m.
const LOAD: [[f64; 3]; 2] = [[300.0, -200.0, 500.0], [20.0, -15.0, 8.0]];

/// Tolerance that is asked, mm: with that of chords (0.4 um) and the last digits the tool keeps within 1 um between the ends of pieces,
/// and within 1e-5 rad, which are 0.5 um at the lever of 50 mm.
const TOLERANCE_MM: f64 = 0.0005;

#[derive(Clone, Copy, PartialEq)]
enum Language {
    Krl,
    Rapid,
    Tp,
    Urscript,
    Val3,
}

/// An arm, its program, and what the script is to know of both.
struct Case {
    name: &'static str,
    language: Language,
    model: &'static str,
    machine: Value,
    text: String,
}

impl Case {
    /// With a model of the library: elastic drives and links.
    fn heavy(language: Language) -> Self {
        let model = concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../kinetostat-model/models/heavy_6r.toml"
        );
        Self {
            name: match language {
                Language::Krl => "KRL, heavy_6r",
                Language::Rapid => "RAPID, heavy_6r",
                Language::Tp => "TP, heavy_6r",
                Language::Urscript => "URScript, heavy_6r",
                Language::Val3 => "VAL3, heavy_6r",
            },
            language,
            model: "heavy_6r",
            machine: json!({ "model": model }),
            text: match language {
                Language::Krl => text(language, "X 12,Y -8,Z 180,A 0,B -90,C 0", [1500, 100, 700]),
                Language::Rapid => text(language, "", [1500, 100, 700]),
                Language::Tp => tp(),
                Language::Urscript => urscript(),
                Language::Val3 => VAL3.to_owned(),
            },
        }
    }

    /// With an arm of a URDF: elastic drives, rigid links, and the weights that the URDF states.
    fn imported(language: Language, here: &Path) -> Option<Self> {
        let (name, file, prefix, origin) = match language {
            Language::Krl => (
                "KRL, KR 210 L150",
                "kuka_kr210l150.urdf",
                "joint_a",
                [1900, 100, 600],
            ),
            _ => (
                "RAPID, IRB 6640",
                "abb_irb6640.urdf",
                "joint_",
                [1850, 100, 800],
            ),
        };
        let urdf = PathBuf::from(env!("CARGO_MANIFEST_DIR"))
            .join("../../../shared/data/urdf")
            .join(file);
        if !urdf.is_file() {
            println!("SKIPPED: ../shared/data/urdf/{file} is not there");
            return None;
        }
        let joints: Vec<String> = (1..=6).map(|i| format!("{prefix}{i}")).collect();
        let mut table = "name,value,unit\n".to_owned();
        for (joint, value) in joints.iter().zip(STIFFNESS) {
            table.push_str(&format!("{joint},{value},N m/rad\n"));
        }
        std::fs::write(here.join("stiffness.csv"), table).unwrap();
        let home = format!("{prefix}2=20deg,{prefix}3=10deg,{prefix}5=60deg");
        let urdf = urdf.to_str().unwrap();
        let import = "import urdf --base base_link --tip tool0 --joint-stiffness stiffness.csv -o arm.toml --home";
        let mut words: Vec<&str> = import.split(' ').collect();
        words.extend([home.as_str(), urdf]);
        run(here, &words).answered();
        Some(Self {
            name,
            language,
            model: "arm.toml",
            machine: json!({
                "urdf": urdf, "base": "base_link", "tip": "tool0",
                "joints": joints, "stiffness_n_m_per_rad": STIFFNESS,
            }),
            text: text(language, "X 180,Y -8,Z 12,A 0,B 0,C 0", origin),
        })
    }

    fn file(&self) -> &'static str {
        match self.language {
            Language::Krl => "part.src",
            Language::Rapid => "part.mod",
            Language::Tp => "part.ls",
            Language::Urscript => "part.script",
            Language::Val3 => "part.pgx",
        }
    }

    /// Compensates the program and asks Pinocchio; `None` where it is not installed.
    fn compared(&self, here: &Path) -> Option<Value> {
        std::fs::write(here.join(self.file()), &self.text).unwrap();
        let (language, axis, orientation) = match self.language {
            Language::Krl => ("krl", "-x", "swivel_and_turn"),
            Language::Rapid => ("rapid", "-z", "one_axis"),
            Language::Tp => ("tp", "-z", "one_axis"),
            Language::Urscript => ("urscript", "-z", "one_axis"),
            Language::Val3 => {
                std::fs::write(here.join("cell.dtx"), val3_data()).unwrap();
                ("val3", "-z", "one_axis")
            }
        };
        let [force, moment] = LOAD;
        // The weights of public URDFs are not those of the robots.
        let job = format!(
            "schema = 1\nmodel = \"{}\"\nprogram = \"{}\"\n[load]\nweight = \"all\"\nforce_n = {force:?}\nmoment_n_m = {moment:?}\naxes = \"base\"\n[robot]\ncorrect = \"pose\"\ntool_axis = \"{axis}\"\n[tolerances]\npath_um = {}\nchord_um = {}\n[output]\npoints = \"points.csv\"\nprogram = \"out/{}\"\n[limits]\nown_weight_mm = 30\ncorrection_mm = 10\n",
            self.model,
            self.file(),
            1e3 * TOLERANCE_MM,
            0.8e3 * TOLERANCE_MM,
            self.file(),
        );
        std::fs::create_dir_all(here.join("out")).unwrap();
        std::fs::write(here.join("job.toml"), job).unwrap();
        run(here, &["compensate", "job.toml", "--all-points"]).answered();
        asked(&json!({
            "language": language, "orientation": orientation, "machine": self.machine,
            "programmed": here.join(self.file()),
            "written": here.join("out").join(self.file()),
            "points": here.join("points.csv"),
            "force_n": force, "moment_n_m": moment, "gravity_m_per_s2": [0.0, 0.0, -9.81],
        }))
    }
}

fn text(language: Language, tool: &str, [x, y, z]: [i32; 3]) -> String {
    match language {
        Language::Krl => KRL
            .replace("TOOL}", &format!("{tool}}}"))
            .replace("X ORIGIN", &format!("X {x},Y {y},Z {z}")),
        _ => RAPID.replace("ORIGIN", &format!("{x},{y},{z}")),
    }
}

/// The numbers of the poses: places, and how the tool stands in a convention.
fn poses(convention: usize) -> impl Iterator<Item = Vec<f64>> {
    let numbers =
        |text: &str| -> Vec<f64> { text.split(", ").map(|n| n.parse().unwrap()).collect() };
    let turns = TURNS[..1].iter().chain(&TURNS);
    let both = PLACES.iter().zip(turns);
    both.map(move |(place, turn)| [numbers(place), numbers(turn[convention])].concat())
}

fn tp() -> String {
    let mut text = "/PROG PART\n/ATTR\nDEFAULT_GROUP\t= 1,*,*,*,*;\n/MN\n".to_owned();
    for (register, values) in [(8, [1500, 100, 700, 0, 0, 20]), (9, [12, -8, 180, 0, 0, 0])] {
        for (part, value) in (1..).zip(values) {
            text += &format!("   1:  PR[{register},{part}]={value} ;\n");
        }
    }
    for line in TP.lines() {
        text += &match line.starts_with("    :") {
            true => format!("{line}\n"),
            false => format!("   1:{line}\n"),
        };
    }
    text += "/POS\n";
    for (number, pose) in (1..).zip(poses(0)) {
        let [x, y, z, w, p, r] = pose[..].try_into().unwrap();
        text += &format!(
            "P[{number}]{{\n   GP1:\n\tUF : 1, UT : 1,\t\tCONFIG : 'N U T, 0, 0, 0',\n\tX = {x:.3} mm, Y = {y:.3} mm, Z = {z:.3} mm,\n\tW = {w:.5} deg, P = {p:.5} deg, R = {r:.5} deg\n}};\n"
        );
    }
    text + "/END\n"
}

fn urscript() -> String {
    let mut text = URSCRIPT.to_owned();
    for (number, mut pose) in (1..).zip(poses(1)) {
        pose[..3].iter_mut().for_each(|part| *part *= 1e-3);
        let pose = format!("pose_trans(table, p{pose:?})");
        text = text.replace(&format!("P{number}"), &pose);
    }
    text
}

fn val3_data() -> String {
    let mut text = "<Database>\n  <Datas>\n".to_owned();
    let mut declare = |name: &str, kind: &str, value: &str| {
        text += &format!(
            "    <Data name=\"{name}\" type=\"{kind}\" size=\"1\">\n      <Value key=\"0\" {value} />\n    </Data>\n"
        );
    };
    let frame = r#"x="1500" y="100" z="700" rz="20" fatherId="world[0]""#;
    declare("fPart", "frame", frame);
    let tool = r#"x="12" y="-8" z="180" fatherId="flange[0]""#;
    declare("tMill", "tool", tool);
    declare("mCut", "mdesc", r#"tmax="20" blend="off""#);
    for (number, pose) in (1..).zip(poses(2)) {
        let [x, y, z, a, b, c] = pose[..].try_into().unwrap();
        let value =
            format!(r#"x="{x}" y="{y}" z="{z}" rx="{a}" ry="{b}" rz="{c}" fatherId="fPart[0]""#);
        declare(&format!("p{number}"), "pointRx", &value);
    }
    text + "  </Datas>\n</Database>\n"
}

/// What the script answers; `None` where Pinocchio is not installed.
fn asked(request: &Value) -> Option<Value> {
    let script = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../validation/scripts/robot_program_pinocchio.py"
    );
    let started = Command::new("python3")
        .arg(script)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn();
    let Ok(mut process) = started else {
        println!("SKIPPED: python3 is not installed");
        return None;
    };
    let mut input = process.stdin.take().unwrap();
    input.write_all(request.to_string().as_bytes()).ok();
    drop(input);
    let output = process.wait_with_output().unwrap();
    if output.status.code() == Some(3) {
        println!("SKIPPED: Pinocchio is not installed (pip install pin)");
        return None;
    }
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    Some(serde_json::from_slice(&output.stdout).unwrap())
}

/// Rows of joint values of heavy_6r, near to each other.
fn joint_table() -> String {
    let mut text = "note,A1_deg,A2_deg,A3_deg,A4_deg,A5_deg,A6_deg,speed_mm_per_s\n".to_owned();
    let [from, to] = [
        [2.0, 7.0, 29.0, 2.4, 48.0, -15.0],
        [8.0, 9.4, 26.6, 5.0, 51.0, -9.0],
    ];
    for row in 0..=20 {
        let share = f64::from(row) / 20.0;
        text.push_str(&format!("row {row}"));
        for (a, b) in from.iter().zip(to) {
            text.push_str(&format!(",{:.4}", a + share * (b - a)));
        }
        text.push_str(",20\n");
    }
    text
}

#[test]
fn figure_tables_of_joint_values_of_heavy_6r_agree_with_pinocchio() {
    let here = tempfile::tempdir().unwrap();
    let here = here.path();
    std::fs::write(here.join("q.csv"), joint_table()).unwrap();
    let line = "compensate --model heavy_6r --weight all --program q.csv --tool-length-mm 180 --force 300 -200 500 --moment 20 -15 8 --correct pose --joint-rows joint --tolerance-um 10";
    run(here, &line.split(' ').collect::<Vec<_>>()).answered();
    let [force, moment] = LOAD;
    let found = asked(&json!({
        "language": "joints", "machine": Case::heavy(Language::Krl).machine,
        "programmed": here.join("q.csv"), "written": here.join("q-compensated.csv"),
        "tool_mm": [0.0, 0.0, 180.0],
        "force_n": force, "moment_n_m": moment, "gravity_m_per_s2": [0.0, 0.0, -9.81],
    }));
    let Some(found) = found else {
        return;
    };
    let number = |name: &str| found[name].as_f64().unwrap_or(f64::NAN);
    let mut holds = true;
    for (key, most, unit) in [("at_points_m", 1e-6, "m"), ("at_points_rad", 1e-5, "rad")] {
        let name = format!("joint values, heavy_6r, Pinocchio: tool at the points, {unit}");
        holds &= figure(&name, number(key), most, unit);
    }
    assert!(holds, "{found}");
    assert!(
        number("without_m") > 3e-4 && number("rows") == 20.0,
        "{found}"
    );
}

fn hold(case: &Case, here: &Path) {
    let Some(found) = case.compared(here) else {
        return;
    };
    let number = |name: &str| found[name].as_f64().unwrap_or(f64::NAN);
    let mut holds = true;
    for (what, key, most, unit) in [
        ("tool at the points", "at_points_m", 1e-6, "m"),
        ("tool at the points", "at_points_rad", 1e-5, "rad"),
        ("tool between them", "between_m", 1e-6, "m"),
        ("tool between them", "between_rad", 1e-5, "rad"),
        // The digits of the table.
        (
            "deflection without compensation against the table's",
            "before_against_table_m",
            2e-9,
            "m",
        ),
        (
            "joint values against the table's",
            "commands_against_table_rad",
            1e-7,
            "rad",
        ),
    ] {
        let name = format!("{}, Pinocchio: {what}, {unit}", case.name);
        holds &= figure(&name, number(key), most, unit);
    }
    assert!(holds, "{found}");
    // There was something to correct, and all of it was looked at.
    assert!(number("without_m") > 3e-4, "{found}");
    assert!(number("without_rad") > 1e-4, "{found}");
    assert_eq!(number("motions"), 4.0);
    assert!(number("pieces") >= 6.0, "{found}");
    assert!(number("pieces_where_the_load_comes") <= 2.0, "{found}");
    assert_eq!(number("written_and_not_seen"), 0.0, "{found}");
}

#[test]
fn figure_robot_programs_of_heavy_6r_agree_with_pinocchio() {
    for language in [
        Language::Krl,
        Language::Rapid,
        Language::Tp,
        Language::Urscript,
        Language::Val3,
    ] {
        let here = tempfile::tempdir().unwrap();
        hold(&Case::heavy(language), here.path());
    }
}

#[test]
fn figure_robot_programs_of_imported_arms_agree_with_pinocchio() {
    for language in [Language::Krl, Language::Rapid] {
        let here = tempfile::tempdir().unwrap();
        if let Some(case) = Case::imported(language, here.path()) {
            hold(&case, here.path());
        }
    }
}
