//! Job, cell and model as text, from the answers.

use std::path::PathBuf;

use crate::files::file_names::stem;
use crate::files::input_files::InputFiles;
use crate::files::paths::seen_from;
use crate::job::format::WeightWord;
use crate::job::target_word::RobotWord;
use crate::start::answers::Answers;
use crate::start::reading::{Cut, Engaged, Stated, word_of};

/// File of the job.
pub(super) const JOB: &str = "job.toml";

/// File of the cell, where the program is written in the language of a robot.
const CELL: &str = "cell.toml";

/// Files that the answers make, with what each is.
pub(super) fn files(answers: &Answers) -> Vec<(&'static str, PathBuf, String)> {
    let at = |name: &str| answers.folder.join(name);
    let robot = answers.robot.as_ref();
    let model = robot.and_then(|robot| Some(("model", at(&robot.named), robot.text.clone()?)));
    let cell = answers
        .to
        .flatten()
        .map(|to| ("cell", at(CELL), cell(answers, to)));
    let job = ("job file", at(JOB), job(answers));
    model.into_iter().chain(cell).chain([job]).collect()
}

/// The files as if they were written.
pub(super) fn in_memory(answers: &Answers) -> InputFiles {
    let mut inputs = InputFiles::default();
    for (_, path, text) in files(answers) {
        inputs.insert(path, text);
    }
    inputs
}

fn job(answers: &Answers) -> String {
    let mut out = "# Written by `kinetostat start`. Lengths in mm, angles in deg, forces in N; what is left out is asked for where it is needed.\nschema = 1\n".to_owned();
    let to = answers.to.flatten();
    if let Some(robot) = &answers.robot {
        out += &format!("model = {}\n", quoted(&robot.named));
    }
    let program = answers.program.as_ref();
    if let Some(program) = program {
        out += &format!(
            "program = {}\n",
            quoted(&seen_from(&answers.folder, &program.path))
        );
    }
    let is_gcode = program.is_some_and(|p| p.language.is_none());
    if is_gcode
        && to.is_none()
        && let Some(part) = &answers.part
    {
        out += &format!(
            "\n[placement]\npart_origin_mm = {}    # program zero in the robot's base\n",
            list(&part.position_mm)
        );
        if let Some(turn) = turn(part) {
            out += &format!("part_orientation = {{ {turn} }}\n");
        }
    }
    let own_tool = answers.tools.first().filter(|_| is_gcode && to.is_none());
    if own_tool.is_some() || !carried(answers).is_empty() || answers.cutter.is_some() {
        out += "\n[tool]\n";
    }
    if let Some(tool) = own_tool {
        out += &match (tool.position_mm, &tool.orientation) {
            ([0.0, 0.0, z], None) => format!("length_mm = {z}    # tip along z of the flange\n"),
            _ => format!("pose = {}    # tip in axes of the flange\n", pose(tool)),
        };
    }
    out += &carried(answers);
    if let Some([diameter, teeth, helix]) = answers.cutter {
        out += &format!(
            "cutter = {{ shape = \"flat\", diameter_mm = {diameter}, teeth = {teeth}, helix_deg = {helix} }}\n"
        );
    }
    out += "\n[load]\n";
    // Until it is answered, a draft leaves the weight out.
    out += match answers.weight {
        Some(WeightWord::All) => "weight = \"all\"    # the part was measured without this robot\n",
        Some(WeightWord::TouchOff) => {
            "weight = \"touch-off\"    # this robot touched the part off: its sag there is in the numbers\n"
        }
        Some(WeightWord::None) | None => "weight = \"none\"    # the controller corrects it\n",
    };
    if let Some(place) = answers.touch_off_mm {
        out += &format!(
            "touch_off_mm = [{}]    # program coordinates\n",
            list(&place)
        );
    }
    if let Some(Cut::Force([radial, tangential, axial])) = answers.cut {
        out += &format!(
            "milling = {{ radial_n = {radial}, tangential_n = {tangential}, axial_n = {axial} }}    # on feed moves; turns with the feed\n"
        );
    }
    if let Some(Cut::Material(name)) = &answers.cut {
        out += &format!("\n[material]\nname = {}\n", quoted(name));
    }
    out += &match &answers.engaged {
        Some(Engaged::Block([a, b, c, d, e, f])) => {
            format!("\n[stock]\nblock_mm = [[{a}, {b}, {c}], [{d}, {e}, {f}]]\n")
        }
        Some(Engaged::Everywhere([width, depth], side)) => format!(
            "\n[engagement]\nwidth_mm = {width}\ndepth_mm = {depth}\npart = \"{side}\"    # of the feed\n"
        ),
        None => String::new(),
    };
    if let Some(rpm) = answers.rpm {
        out += &format!("\n[spindle]\nrpm = {rpm}\nrotation = \"clockwise\"\n");
    }
    out += &robot(answers, to);
    if program.is_some_and(|program| program.expanded) {
        out += "\n[expand]    # run once and written flat\n";
    }
    if let Some(tolerance) = answers.tolerance_um {
        out += &format!("\n[tolerances]\npath_um = {tolerance}\n");
    }
    if let Some(program) = program {
        out += &format!(
            "\n[output]\nreport = {}\n",
            quoted(&format!("{}.html", stem(&program.path)))
        );
    }
    out
}

/// The table `[robot]`, if there is anything in it.
fn robot(answers: &Answers, to: Option<RobotWord>) -> String {
    let mut out = String::new();
    if let Some(to) = to {
        out += &format!(
            "to = \"{}\"\ntemplate = \"{CELL}\"    # where part and tool are, and what the controller calls them\n",
            word_of(to)
        );
    }
    if let Some(axis) = &answers.tool_axis {
        out += &format!(
            "tool_axis = \"{axis}\"    # from the tip to the spindle, in axes of the tool\n"
        );
    }
    if let Some(air) = answers.air_mm_per_s {
        out += &format!(
            "rapid_from_mm_per_s = {air}    # straight motions from this speed on are in air\n"
        );
    }
    let Some(program) = answers.program.as_ref().filter(|p| p.language.is_some()) else {
        return headed("robot", out);
    };
    let tools = program.tools.iter().zip(&answers.tools);
    let part = program.work_object.iter().zip(&answers.part);
    let frames = tools
        .chain(part)
        .map(|(name, stated)| format!("{} = {}\n", quoted(name), pose(stated)));
    headed("robot", out) + &headed("robot.frames", frames.collect())
}

fn headed(name: &str, content: String) -> String {
    match content.is_empty() {
        true => content,
        false => format!("\n[{name}]\n{content}"),
    }
}

fn cell(answers: &Answers, to: RobotWord) -> String {
    let mut out = "# Written by `kinetostat start`: what G-code does not say of the robot's cell. `kinetostat help convert` shows all keys.\nschema = 1\n".to_owned();
    out += "tool_orientation = { rotation_vector_deg = [180, 0, 0] }    # z of the tool points into the part\n";
    let [base, tool] = answers.numbers.unwrap_or([1, 1]);
    // A frame with a pose needs no number in the other languages.
    let number = |n: u32| match to {
        RobotWord::Ls => format!("number = {n}\n"),
        RobotWord::Krl | RobotWord::Rapid => String::new(),
    };
    out += &format!(
        "\n[base]    # the part in the robot's base\n{}",
        number(base)
    );
    if let Some(part) = &answers.part {
        out += &format!("pose = {}\n", pose(part));
    }
    out += &format!("\n[tool]    # its tip in the flange\n{}", number(tool));
    if let Some(tool) = answers.tools.first() {
        out += &format!("pose = {}\n", pose(tool));
    }
    out += &carried(answers);
    let keys = ["clockwise", "stop"].into_iter().zip(&answers.spindle);
    let stated = keys.filter(|(_, statements)| !statements.is_empty());
    let stated: String = stated
        .map(|(key, own)| {
            let own: Vec<String> = own.iter().map(|statement| quoted(statement)).collect();
            format!("{key} = [{}]\n", own.join(", "))
        })
        .collect();
    out += &headed("spindle", stated);
    out
}

/// Mass on the flange, if it was answered.
fn carried(answers: &Answers) -> String {
    let Some(mass) = answers.mass_kg.filter(|mass| *mass > 0.0) else {
        return String::new();
    };
    let centre = answers
        .tools
        .first()
        .map(|tool| tool.position_mm.map(|x| 0.5 * x));
    let centre = centre.map(|centre| {
        format!(
            "centre_of_mass_mm = {}    # taken halfway to the tip\n",
            list(&centre)
        )
    });
    format!(
        "mass_kg = {mass}    # spindle and tool\n{}",
        centre.unwrap_or_default()
    )
}

fn pose(stated: &Stated) -> String {
    let turn = turn(stated).map_or_else(String::new, |turn| format!(", {turn}"));
    format!("{{ position_mm = {}{turn} }}", list(&stated.position_mm))
}

fn turn(stated: &Stated) -> Option<String> {
    let (name, numbers) = stated.orientation.as_ref()?;
    Some(format!("{name} = {}", list(numbers)))
}

fn list(numbers: &[f64]) -> String {
    let words: Vec<String> = numbers.iter().map(f64::to_string).collect();
    format!("[{}]", words.join(", "))
}

/// A text of TOML.
fn quoted(text: &str) -> String {
    toml::Value::from(text).to_string()
}
