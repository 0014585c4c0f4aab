//! `kinetostat import urdf`: a model from a robot description.

use std::collections::BTreeMap;
use std::path::Path;

use kinetostat::MotionKind;
use kinetostat_diagnostic::ErrorCode;
use kinetostat_import::{
    Imported, JointStiffness, LoopFile, UrdfOptions, import_urdf, read_section,
};
use kinetostat_model::schema::AxisName;
use schemars::JsonSchema;
use serde::Serialize;

use crate::files::csv_text::with_decimal_points;
use crate::files::input_files::InputFiles;
use crate::files::outputs::{Existing, Outputs};
use crate::files::standard_input;
use crate::import::arguments::UrdfArgs;
use crate::ui::failure::{Answer, Failing};
use crate::ui::json;
use crate::ui::layout::{item, listed, wrapped};
use crate::ui::screen::{self, Stream};

/// The import, stable names with units.
#[derive(Serialize, JsonSchema)]
pub(crate) struct ImportSummary<'a> {
    schema: u32,
    kinetostat_version: &'static str,
    source: String,
    output: Option<String>,
    robot: &'a str,
    base: &'a str,
    tip: &'a str,
    actuators: &'a [String],
    rigid_drives: &'a [String],
    passive_joints: &'a [String],
    coupled_joints: &'a [String],
    bodies: Vec<BodySummary<'a>>,
    mass_kg: f64,
    loops: usize,
    platforms: Vec<&'a str>,
    limbs: Vec<&'a str>,
    notices: Vec<Notice<'a>>,
}

#[derive(Serialize, JsonSchema)]
struct BodySummary<'a> {
    name: &'a str,
    mass_kg: f64,
}

#[derive(Serialize, JsonSchema)]
struct Notice<'a> {
    message: &'a str,
    help: &'a str,
    file: &'a str,
    line: Option<usize>,
    column: Option<usize>,
    element: &'a str,
}

pub(crate) fn urdf(args: &UrdfArgs) -> Answer<()> {
    let mut inputs = vec![args.file.clone()];
    inputs.extend(args.loops.clone());
    inputs.extend(args.link_section.clone());
    let text = text("URDF file", &args.file)?;
    let options = options(args, &mut inputs)?;
    let existing = Existing::forced(args.force_overwrite);
    let mut outputs = Outputs::new(existing, inputs);
    let claimed = match &args.out {
        Some(path) => Some(outputs.claim("model file", path)?),
        None => None,
    };
    let imported = import_urdf(&text, &args.file.display().to_string(), &options)?;
    if let Some(index) = claimed {
        outputs.fill(index, imported.toml.as_bytes())?;
        outputs.commit()?;
    }
    let text = answer_text(
        &imported,
        &args.file.display().to_string(),
        args.out.as_deref(),
    );
    if args.json {
        screen::print(Stream::Err, &text)?;
        return screen::print_bytes(json::json(&summary(&imported, args))?.as_bytes());
    }
    if args.out.is_some() {
        return screen::print(Stream::Out, &text);
    }
    // The model itself is the result.
    screen::print(Stream::Err, &text)?;
    screen::print_bytes(imported.toml.as_bytes())
}

/// Text of an input.
fn text(what: &str, path: &Path) -> Answer<String> {
    match standard_input::is(path) {
        true => InputFiles::default().text(what, path),
        false => Ok(kinetostat_import::read_text(what, path)?),
    }
}

fn options(args: &UrdfArgs, inputs: &mut Vec<std::path::PathBuf>) -> Answer<UrdfOptions> {
    let named = |path: &Path| path.display().to_string();
    let loops = match &args.loops {
        Some(path) => Some(LoopFile {
            file: named(path),
            text: text("loop file", path)?,
        }),
        None => None,
    };
    let stiffness = match &args.joint_stiffness {
        None => JointStiffness::Unknown,
        Some(word) => match word.trim().parse::<f64>() {
            Ok(value) => JointStiffness::All(value),
            Err(_) => {
                let path = Path::new(word);
                inputs.push(path.to_owned());
                JointStiffness::Table {
                    file: word.clone(),
                    text: with_decimal_points(&text("table of joint stiffnesses", path)?)
                        .into_owned(),
                }
            }
        },
    };
    let section = match &args.link_section {
        Some(path) => Some(read_section(&text("section file", path)?, &named(path))?),
        None => None,
    };
    let mut home = BTreeMap::new();
    for written in &args.home {
        let (joint, value) = home_of(written)?;
        home.insert(joint, value);
    }
    Ok({
        let mut options = UrdfOptions::default();
        options.base = args.base.clone();
        options.tip = args.tip.clone();
        options.flange_z = args.flange_z.as_deref().map(|axis| match axis {
            "x" => AxisName::X,
            "y" => AxisName::Y,
            _ => AxisName::Z,
        });
        options.loops = loops;
        options.passive = args.passive.clone();
        options.home = home;
        options.stiffness = stiffness;
        options.section = section;
        options
    })
}

/// `joint_5=30deg`, `rail=1200mm`: an angle in rad or a distance in m.
fn home_of(written: &str) -> Answer<(String, (MotionKind, f64))> {
    let wrong = || {
        ErrorCode::Value.failure(format!(
                "--home: '{written}' is not JOINT=VALUE with a unit; write joint_5=30deg, joint_5=0.5rad, rail=1200mm or rail=1.2m"
            ),
        )
    };
    let (joint, value) = written.rsplit_once('=').ok_or_else(wrong)?;
    let units = [
        ("deg", MotionKind::Revolute, std::f64::consts::PI / 180.0),
        ("rad", MotionKind::Revolute, 1.0),
        ("mm", MotionKind::Prismatic, 1e-3),
        ("m", MotionKind::Prismatic, 1.0),
    ];
    let (number, kind, factor) = units
        .iter()
        .find_map(|(unit, kind, factor)| Some((value.trim().strip_suffix(unit)?, *kind, factor)))
        .ok_or_else(wrong)?;
    let number: f64 = number.trim().parse().map_err(|_| wrong())?;
    if joint.trim().is_empty() || !number.is_finite() {
        return Err(wrong());
    }
    Ok((joint.trim().to_owned(), (kind, number * factor)))
}

fn mass(imported: &Imported) -> f64 {
    imported.bodies.iter().map(|b| b.1).sum()
}

fn summary<'a>(imported: &'a Imported, args: &UrdfArgs) -> ImportSummary<'a> {
    let document = &imported.model.document;
    ImportSummary {
        schema: 1,
        kinetostat_version: env!("CARGO_PKG_VERSION"),
        source: args.file.display().to_string(),
        output: args.out.as_ref().map(|p| p.display().to_string()),
        robot: &imported.name,
        base: &imported.base,
        tip: &imported.tip,
        actuators: &imported.actuators,
        rigid_drives: &imported.rigid_drives,
        passive_joints: &imported.passive_joints,
        coupled_joints: &imported.coupled_joints,
        bodies: imported
            .bodies
            .iter()
            .map(|(name, mass)| BodySummary {
                name,
                mass_kg: *mass,
            })
            .collect(),
        mass_kg: mass(imported),
        loops: imported.loops,
        platforms: document.platform.iter().map(|p| p.name.as_str()).collect(),
        limbs: document.limb.iter().map(|l| l.name.as_str()).collect(),
        notices: imported
            .notices
            .iter()
            .chain(&imported.model.warnings)
            .map(|n| Notice {
                message: &n.message,
                help: &n.help,
                file: &n.file,
                line: n.line,
                column: n.column,
                element: &n.path,
            })
            .collect(),
    }
}

fn answer_text(imported: &Imported, source: &str, out: Option<&Path>) -> String {
    let mut text = wrapped(
        &format!(
            "{}: from '{}' to '{}'",
            imported.name, imported.base, imported.tip
        ),
        0,
    );
    let row = |what: &str, names: &[String]| {
        let list = match names {
            [] => "none".to_owned(),
            names => names.join(", "),
        };
        vec![what.to_owned(), list]
    };
    let mut rows = vec![row("actuators", &imported.actuators)];
    if !imported.coupled_joints.is_empty() {
        rows.push(row("follow them", &imported.coupled_joints));
    }
    if !imported.passive_joints.is_empty() {
        rows.push(row("passive", &imported.passive_joints));
    }
    if imported.loops > 0 {
        rows.push(vec!["closed loops".into(), imported.loops.to_string()]);
    }
    rows.push(vec![
        "moving mass".into(),
        match imported.bodies.len() {
            0 => "none".into(),
            n => format!("{:.1} kg in {n} bodies", mass(imported)),
        },
    ]);
    rows.push(row("rigid drives", &imported.rigid_drives));
    text.push_str(&listed(&rows, 2));
    let notices: Vec<_> = imported
        .notices
        .iter()
        .chain(&imported.model.warnings)
        .collect();
    if !notices.is_empty() {
        text.push_str("\nNotices\n");
        for n in notices {
            // Lines of the written model beside those of the URDF: the file is named.
            let file = match imported.notices.iter().any(|own| std::ptr::eq(own, n)) {
                true if n.file == source => String::new(),
                true => format!("{}: ", n.file),
                false => "in the model: ".to_owned(),
            };
            let line = n.line.map_or(String::new(), |l| format!("line {l}: "));
            let place = file + &line;
            let help = match n.help.as_str() {
                "" => String::new(),
                help => format!("; {help}"),
            };
            text.push_str(&item(&format!("{place}{}{help}", n.message)));
        }
    }
    if let Some(path) = out {
        text.push_str(&format!("\nWritten\n  {}\n", path.display()));
        text.push_str("\nNext\n");
        text.push_str(&wrapped(
            &format!(
                "{}kinetostat check {}",
                match imported.rigid_drives.is_empty() {
                    true => "",
                    false => "fill in what bends (FILL IN), then: ",
                },
                path.display()
            ),
            2,
        ));
    }
    text
}
