//! Every option, from the command tree itself, given to every command: it changes what is said or written, or it is refused.

#![allow(clippy::unwrap_used, reason = "a failing test may panic")]

use std::path::Path;
use std::sync::Mutex;

use crate::common::{MODEL, PROGRAM, contents, run};

/// A line for each command and each of its modes, which answers.
const LINES: [&str; 41] = [
    "compensate job.toml",
    "compensate --map map.csv --program part.ngc --out w.ngc",
    "compensate --no-compensation --program part.ngc --out w.ngc",
    "deflect job.toml",
    "deflect mill.toml",
    "deflect orthoglide --at 0 0 0 --force 1 0 0",
    "verify own.ngc --job job.toml",
    "stiffness orthoglide --at 0 0 0",
    "shares orthoglide --at 0 0 0 --direction x",
    "modes heavy_6r",
    "frf heavy_6r --damping 0.03 --frequencies 5 80 20",
    "lobes heavy_6r --damping 0.03 --rpm 1000 6000 8 --teeth 2 --coefficients-n-per-mm2 800 240 0",
    "lobes heavy_6r --damping 0.03 --rpm 1000 6000 8 --teeth 2 --material AlMg4.5Mn --feed-per-tooth-mm 0.08",
    "chatter mill.toml --damping 0.03",
    "compare orthoglide orthoglide",
    "map orthoglide --x -100 100 3 --y -100 100 3",
    "place job.toml --x-mm -20 20 --samples 4",
    "curve three_link_z --direction -1 0 0 --displacement-mm 0 40",
    "equilibria three_link_z --starts 8",
    "force --material AlMg4.5Mn --tool flat --diameter-mm 10 --teeth 2 --width-mm 4 --depth-mm 2 --feed-per-tooth-mm 0.1 --rpm 8000 --climb",
    "force --list-materials",
    "force --material C45 --drill --diameter-mm 8 --feed-per-turn-mm 0.2 --rpm 1200",
    "force --material C45 --turning --depth-mm 2 --feed-per-turn-mm 0.3 --approach-angle-deg 75 --speed-m-per-min 150",
    "engagement mill.toml",
    "expand part.ngc",
    "convert part.ngc --to apt --out w.apt",
    "check orthoglide",
    "check arm.toml",
    "check job.toml",
    "dialect list",
    "model list",
    "view orthoglide --export page.html",
    "model show orthoglide",
    "reproduce table-5.1",
    "demo",
    "mirror part.ngc --measured trial.csv --register none --out next.ngc",
    "tolerance orthoglide --uncertain spread.toml --at 0 0 0 --force 1 0 0 --machines 16",
    "identify heavy_6r --measured pulls.csv",
    "plan-measurement heavy_6r --pull-n 800 --count 6 --candidates 20",
    "assemble askew.toml --at 0 0 0",
    "import urdf crane.urdf --base post --tip trolley --out crane.toml",
];

/// Commands without a line: what they print is no answer to a question.
const WITHOUT_A_LINE: [&str; 6] = ["completions", "explain", "help", "man", "schema", "start"];

/// Options that may change nothing, of one command or of all: leave to overwrite and to begin anew, speed, bounds that are kept
/// here, and facts of machine and program that this program does not need.
const MAY_BE_IDLE: [(&str, &str); 30] = [
    ("", "force-overwrite"),
    ("", "restart"),
    ("", "threads"),
    ("compensate", "again"),
    ("", "arc-tolerance"),
    ("curve", "branches"),
    ("compensate --map", "backward-step-um"),
    ("compensate --map", "min-block-mm"),
    ("compensate", "max-feed-factor"),
    ("", "block-delete"),
    ("", "axes-stand-still"),
    ("", "tool-centre-point"),
    ("", "start-position-mm"),
    ("", "machine-zero-mm"),
    ("verify", "expand"),
    ("place", "expand"),
    ("compensate --no-compensation", "model"),
    ("compensate --no-compensation", "work-offset"),
    ("compensate --no-compensation", "units"),
    ("expand", "work-offset"),
    ("expand", "units"),
    ("expand", "subprograms"),
    ("expand", "dialect"),
    ("expand", "tool-diameter-mm"),
    ("expand", "parameter"),
    ("mirror", "window-mm"),
    ("mirror", "align"),
    ("mirror", "units"),
    // It is so without it, too.
    ("lobes", "climb"),
    ("import", "flange-z"),
];

/// Measured displacements of `heavy_6r`, with one that does not fit.
pub(crate) const PULLS: &str = "posture,joint 1_deg,joint 2_deg,joint 3_deg,joint 4_deg,joint 5_deg,joint 6_deg,fx_n,fy_n,fz_n,dx_mm,dy_mm,dz_mm\n1,0,-60,60,10,60,0,1000,0,0,0.165,-0.013,0.223\n2,30,-50,50,30,40,20,0,1000,0,-0.146,0.270,0.032\n3,-30,-55,70,-20,70,-30,0,0,-1000,-0.263,0.205,-0.447\n4,10,-40,80,60,-50,80,1000,500,0,0.692,0.103,0.357\n5,-50,-30,60,-40,80,10,600,-800,-300,0.333,-0.268,0.125\n";

const JOB: &str = "schema = 1\nmodel = \"orthoglide\"\nprogram = \"part.ngc\"\n[placement]\npart_origin_mm = [0, 0, 100]\n[tool]\nlength_mm = 100\n[load]\nmilling = { radial_n = 215, tangential_n = -10, axial_n = -25 }\n";
const MILL: &str = "schema = 1\nmodel = \"heavy_6r\"\nprogram = \"part.ngc\"\n[placement]\npart_origin_mm = [1300, 0, 800]\ntool_orientation = { a_b_c_kuka_deg = [160, 0, 180] }\n[tool]\npose = { position_mm = [200, 0, 100], a_b_c_kuka_deg = [0, 90, 0] }\ncutter = { shape = \"flat\", diameter_mm = 10, teeth = 2, helix_deg = 30 }\n[load]\nweight = \"all\"\n[material]\nname = \"AlMg4.5Mn\"\n[stock]\nblock_mm = [[-30, -20, -12], [30, 30, 0]]\n";

fn workplace(own: Option<&[u8]>) -> tempfile::TempDir {
    let here = tempfile::tempdir().unwrap();
    let put = |name: &str, bytes: &[u8]| std::fs::write(here.path().join(name), bytes).unwrap();
    put(
        "part.ngc",
        PROGRAM.replace("G0 X20", "S8000 M3\nG0 X20").as_bytes(),
    );
    put("job.toml", JOB.as_bytes());
    put("mill.toml", MILL.as_bytes());
    put("arm.toml", MODEL.as_bytes());
    let mut map = "x_mm,y_mm,z_mm,dx_mm,dy_mm,dz_mm\n".to_owned();
    for x in [-50, 50] {
        for y in [-50, 50] {
            for z in [-10, 10] {
                map += &format!("{x},{y},{z},0.01,0.02,{}\n", 4e-5 * f64::from(x * y));
            }
        }
    }
    put("map.csv", map.as_bytes());
    put("other.ngc", PROGRAM.replace("X20", "X21").as_bytes());
    let points = (0..=90).map(|deg| {
        let (y, x) = f64::from(deg).to_radians().sin_cos();
        format!("{},{},-1.01\n", 20.02 * -y, 20.02 * x)
    });
    let along = (0..=40).map(|k| {
        format!(
            "{},{},-1.01\n",
            20.0 - 0.5 * f64::from(k),
            0.5 * f64::from(k)
        )
    });
    let trial = "x_mm,y_mm,z_mm\n".to_owned() + &along.chain(points).collect::<String>();
    put("trial.csv", trial.as_bytes());
    put(
        "spread.toml",
        b"schema = 1\n[[uncertain]]\nload = \"force_n.x\"\nuniform_percent = 10\n",
    );
    let preset = include_str!("../../../kinetostat-model/models/orthoglide.toml");
    let askew = format!(
        "{preset}\n[[deviation]]\nlimb = \"leg x\"\nat = \"line\"\nmoved_by = {{ rotation_vector_deg = [1, 0, 0] }}\n"
    );
    put("askew.toml", askew.as_bytes());
    put("pulls.csv", PULLS.as_bytes());
    put("crane.urdf", crate::import::URDF.as_bytes());
    if let Some(own) = own {
        put("own.ngc", own);
    }
    here
}

/// A value that no command has by default, for every option; none for a flag.
fn values(option: &clap::Arg, line: &str) -> Vec<String> {
    let name = option.get_long().unwrap();
    let defaults: Vec<String> = option
        .get_default_values()
        .iter()
        .map(|value| value.to_string_lossy().into_owned())
        .collect();
    if !option.get_action().takes_values() {
        return Vec::new();
    }
    let possible = option.get_possible_values();
    let mut possible = possible
        .iter()
        .rev()
        .map(|value| value.get_name().to_owned());
    if let Some(value) = possible.find(|value| !defaults.contains(value)) {
        return vec![value];
    }
    let text: &[&str] = match name {
        "at" => &["10", "5", "20"],
        "force" => &["50", "-40", "-30"],
        "milling" => &["100", "-10", "-25"],
        "tool-length-mm" => &["37"],
        "part-origin-mm" => &["1", "2", "101"],
        "part-orientation" | "tool-orientation" | "rotation" => &["a_b_c_kuka_deg=5,0,0"],
        "scale" => &["0.9"],
        "below-z-mm" => &["-2"],
        "work-offset" => &["G54=1,0,0"],
        "call" => &["SPINDLE=moves"],
        "set" => &["di1=1"],
        "tool-diameter-mm" => &["1=6.5"],
        "parameter" => &["100=2.5"],
        "subprograms" => &["."],
        "limit" if line.contains("--map") || line.starts_with("mirror") => &["correction_mm=0.01"],
        "limit" => &["force_n=1"],
        "depth-mm" | "max-blocks-per-second" => &["0.01"],
        "most-places" => &["1"],
        "decimals" => &["5"],
        "max-feed-factor" => &["1.1"],
        "max-chip-mm" => &["0.01"],
        "samples" | "starts" | "modes" | "points" | "machines" | "branches" | "fit" => &["7"],
        "x" | "y" | "z" => &["0", "20", "2"],
        "json" => &["made.json"],
        "program" | "against" => &["other.ngc"],
        "model" if line.contains("mill") => &["orthoglide"],
        "model" => &["heavy_6r"],
        _ => {
            let names = option.get_value_names().unwrap_or_default();
            let count = option
                .get_num_args()
                .map_or(1, |range| range.min_values().max(1));
            let is_file = names
                .iter()
                .any(|name| ["FILE", "DIR"].contains(&name.as_str()));
            let value = match (is_file, name) {
                (true, "plot" | "turn-plot") => "made.svg",
                (true, "csv" | "points" | "measured") => "made.csv",
                (true, _) => "made.x",
                _ => "1.5",
            };
            return vec![value.to_owned(); count];
        }
    };
    text.iter().map(|&word| word.to_owned()).collect()
}

/// Exit code, text, and files with their bytes.
fn outcome(here: &Path, words: &[&str]) -> (i32, String, Vec<(String, Vec<u8>)>) {
    let said = run(here, words);
    let files = contents(here).into_iter().map(|(path, bytes)| {
        let name = path.strip_prefix(here).unwrap();
        (name.display().to_string(), bytes)
    });
    (said.code, said.out + &said.err, files.collect())
}

fn leaf<'c>(tree: &'c clap::Command, words: &[&str]) -> &'c clap::Command {
    words.iter().fold(tree, |command, word| {
        command.find_subcommand(word).unwrap_or(command)
    })
}

#[test]
fn every_option_of_every_command_acts_or_is_refused() {
    let mut tree = kinetostat_cli::command();
    tree.build();
    for command in tree.get_subcommands() {
        let has_line = LINES
            .iter()
            .any(|line| line.split(' ').next() == Some(command.get_name()));
        let is_known = WITHOUT_A_LINE.contains(&command.get_name());
        assert!(has_line || is_known, "no line for {}", command.get_name());
    }
    let own = {
        let here = workplace(None);
        run(here.path(), &["compensate", "job.toml", "--out", "own.ngc"]).answered();
        std::fs::read(here.path().join("own.ngc")).unwrap()
    };
    let next = Mutex::new(LINES.iter());
    let dropped = Mutex::new(Vec::new());
    let work = || {
        loop {
            let Some(line) = next.lock().unwrap().next() else {
                break;
            };
            let words: Vec<&str> = line.split(' ').collect();
            let here = workplace(Some(&own));
            let plain = outcome(here.path(), &words);
            // A program that is written, and keeps its tolerance on assumptions, is an answer.
            if !matches!(plain.0, 0 | 4) {
                dropped
                    .lock()
                    .unwrap()
                    .push(format!("{line}: no answer: {}", plain.1));
                continue;
            }
            for option in leaf(&tree, &words[..2.min(words.len())]).get_arguments() {
                let Some(name) = option.get_long() else {
                    continue;
                };
                let flag = format!("--{name}");
                // The machine of this job has no masses.
                let is_weightless = name == "weight" && line.contains("job.toml");
                let mut idle = MAY_BE_IDLE.iter();
                let is_idle = idle.any(|(of, idle)| line.starts_with(of) && *idle == name)
                    || option.is_hide_set()
                    || is_weightless;
                if is_idle || name == "help" || words.contains(&flag.as_str()) {
                    continue;
                }
                let values = values(option, line);
                let mut with = words.clone();
                with.push(&flag);
                with.extend(values.iter().map(String::as_str));
                let here = workplace(Some(&own));
                let found = outcome(here.path(), &with);
                let acts = found != plain;
                if !acts || !(0..=4).contains(&found.0) || found.1.contains("panicked") {
                    let with = with.join(" ");
                    dropped
                        .lock()
                        .unwrap()
                        .push(format!("{with}: exit {}", found.0));
                }
            }
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(work);
        }
    });
    let dropped = dropped.into_inner().unwrap();
    assert!(
        dropped.is_empty(),
        "dropped in silence:\n{}",
        dropped.join("\n")
    );
}

/// Random options, two and three at a time, on random commands: an answer or a refusal, never a panic. Longer, and with another
/// seed, in `cargo xtask fuzz`.
#[test]
fn random_options_end_in_an_answer_or_a_refusal() {
    let mut tree = kinetostat_cli::command();
    tree.build();
    let own = b"G21 G90\nG0 X20 Y0 Z5\nG1 Z-1 F300\nG1 X0 Y20 F600\n";
    let mut random = super::jobs_over_commands::Random::of_environment();
    random.for_a_while(|random| {
        let line = *random.one_of(&LINES);
        let mut with: Vec<String> = line.split(' ').map(str::to_owned).collect();
        let options: Vec<clap::Arg> = {
            let words: Vec<&str> = line.split(' ').collect();
            let all = leaf(&tree, &words[..words.len().min(2)]).get_arguments();
            all.filter(|option| option.get_long().is_some_and(|name| name != "help"))
                .cloned()
                .collect()
        };
        for _ in 0..random.below(3) + 1 {
            if options.is_empty() {
                break;
            }
            let option = random.one_of(&options);
            with.push(format!("--{}", option.get_long().unwrap()));
            let odd = [
                "-1", "0", "1e9", "nan", "", "part.ngc", "job.toml", "map.csv", "x=1", ".",
            ];
            let mut given = values(option, line);
            if random.below(3) == 0 {
                for value in &mut given {
                    *value = (*random.one_of(&odd)).to_owned();
                }
            }
            with.extend(given);
        }
        let here = workplace(Some(own));
        let words: Vec<&str> = with.iter().map(String::as_str).collect();
        let found = outcome(here.path(), &words);
        assert!(
            (0..=4).contains(&found.0) && !found.1.contains("panicked"),
            "{}: exit {}: {}",
            with.join(" "),
            found.0,
            found.1
        );
    });
}
