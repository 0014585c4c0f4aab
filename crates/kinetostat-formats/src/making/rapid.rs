//! Programs in RAPID: one module with its tool, work object, speeds and motions; of a long one further modules.
//!
//! Source: ABB, Technical reference manual, RAPID Instructions, Functions and Data types (3HAC050917).

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::{Isometry3, UnitQuaternion, Vector3};

use crate::making::events::EventAction;
use crate::making::names::{angles, base_name, coordinates, fixed, name_of_tool, of_part, short};
use crate::making::stated::is_number_zero;
use crate::making::step::{MadeMotion, Step, Way, parts};
use crate::making::template::Template;
use crate::model::orientation::OrientationText;

/// Limit of the named speeds; later ones are written inline.
const MOST_NAMED_SPEEDS: usize = 200;

/// Zones that controllers know by name, mm.
const ZONES: [f64; 14] = [
    0.3, 1.0, 5.0, 10.0, 15.0, 20.0, 30.0, 40.0, 50.0, 60.0, 80.0, 100.0, 150.0, 200.0,
];

/// External axes that are not there.
const NO_AXES: &str = "[9E9,9E9,9E9,9E9,9E9,9E9]";

/// Speeds of turning, deg/s, and of external axes, mm/s and deg/s, of the speeds that controllers know by name.
pub(crate) const OTHER_SPEEDS: &str = "500,5000,1000";

/// A configuration that is not known, and that nothing goes by.
const UNKNOWN: &str = "[0,0,0,0]";

/// The files of a program: the main one first.
pub(crate) fn files(
    steps: &[Step],
    name: &str,
    most: usize,
    template: &Template,
    made_by: &str,
) -> Vec<(String, Vec<u8>)> {
    let ranges = parts(steps, most);
    let mut writer = Writer::of(steps, template);
    let mut text = format!("MODULE {name}\n  ! {made_by}\n{}", writer.declarations());
    let mut files = Vec::with_capacity(ranges.len());
    let several = ranges.len() > 1;
    text += "  PROC main()\n";
    // The configuration in MoveL is not checked: on a straight line the arm keeps its configuration.
    let first = steps.iter().find_map(Step::motion);
    writer.follow_configuration(first.is_some_and(|first| writer.goes_by(first)), &mut text);
    text += "    ConfL\\Off;\n";
    // Without this setting, the tool turns with the path on a circle.
    let circles = |motion: &MadeMotion| matches!(motion.way, Way::Circle { .. });
    if steps.iter().filter_map(Step::motion).any(circles) {
        text += "    CirPathMode\\ObjectFrame;\n";
    }
    if let Some(acceleration) = template.acceleration_m_per_s2 {
        text += &format!(
            "    PathAccLim TRUE\\AccMax:={},TRUE\\DecelMax:={};\n",
            short(acceleration, 6),
            short(acceleration, 6)
        );
    }
    if let Some(joints) = &template.start_joints_deg {
        let joints: Vec<String> = joints.iter().map(|value| short(*value, 6)).collect();
        let tool = writer.tool_name();
        text += &format!(
            "    MoveAbsJ [[{}],{NO_AXES}],vJoint,fine,{tool};\n",
            joints.join(",")
        );
    }
    if several {
        for part in 0..ranges.len() {
            text += &format!("    {};\n", of_part(name, part));
        }
        text += "  ENDPROC\nENDMODULE\n";
        files.push((format!("{name}.mod"), text.into_bytes()));
        for (part, range) in ranges.into_iter().enumerate() {
            let own = of_part(name, part);
            // The name of the module is that of its file; that of the routine is called.
            let mut text = format!("MODULE m{own}\n  PROC {own}()\n");
            for step in &steps[range] {
                writer.step(step, &mut text);
            }
            text += "  ENDPROC\nENDMODULE\n";
            files.push((format!("{own}.mod"), text.into_bytes()));
        }
        return files;
    }
    for step in steps {
        writer.step(step, &mut text);
    }
    text += "  ENDPROC\nENDMODULE\n";
    files.push((format!("{name}.mod"), text.into_bytes()));
    files
}

struct Writer<'t> {
    template: &'t Template,
    /// Names of speeds by their data as written.
    speeds: BTreeMap<String, String>,
    tool: Option<u32>,
    /// Some motion goes with the tool of the template that has no number in the program.
    uses_tool: bool,
    /// True after `ConfJ\On`: joint motions reach their stated configuration; `None` before the first switch.
    follows_configuration: Option<bool>,
}

impl<'t> Writer<'t> {
    fn of(steps: &[Step], template: &'t Template) -> Self {
        let mut writer = Self {
            template,
            speeds: BTreeMap::new(),
            tool: None,
            uses_tool: true,
            follows_configuration: None,
        };
        // The motion to the initial joint values uses the tool of the first motion.
        let first = steps.iter().take_while(|step| step.motion().is_none());
        writer.tool = first.fold(None, |tool, step| match step {
            Step::Tool(number) => Some(*number),
            _ => tool,
        });
        writer.uses_tool = uses_tool(steps, template);
        let rapid = writer.speed_data(template.rapid_speed_mm_per_s, None);
        writer.speeds.insert(rapid, "vRapid".to_owned());
        for motion in steps.iter().filter_map(Step::motion) {
            let data = writer.speed_of(motion);
            let count = writer.speeds.len();
            if count < MOST_NAMED_SPEEDS {
                let name = || format!("vFeed{count}");
                writer.speeds.entry(data).or_insert_with(name);
            }
        }
        writer
    }

    /// Components of a speeddata: of the TCP, of rotation, of external axes.
    fn speed_data(&self, mm_per_s: f64, others: Option<&str>) -> String {
        let number = short(mm_per_s, self.template.speed_decimals.unwrap_or(9));
        format!("{number},{}", others.unwrap_or(OTHER_SPEEDS))
    }

    fn speed_of(&self, motion: &MadeMotion) -> String {
        self.speed_data(motion.speed_mm_per_s, motion.other_speeds.as_deref())
    }

    fn declarations(&self) -> String {
        let mut text = String::new();
        let own = self.uses_tool.then_some((None, &self.template.tool));
        let numbered = self.template.tools.iter();
        let numbered = numbered.map(|(number, tool)| (Some(*number), tool));
        let mut declared = BTreeSet::new();
        for (number, tool) in own.into_iter().chain(numbered) {
            // tool0 and wobj0 are predefined.
            let Some(pose) = (tool.frame.pose.as_ref()).filter(|_| !is_number_zero(&tool.frame))
            else {
                continue;
            };
            // Two of one name are one.
            if !declared.insert(name_of_tool(number, tool).to_ascii_uppercase()) {
                continue;
            }
            let mass = short(tool.mass_kg.unwrap_or(1.0), 6);
            // A centre of mass at the flange itself is refused by controllers.
            let centre = tool
                .centre_of_mass_mm
                .unwrap_or_else(|| Vector3::new(0.0, 0.0, 1.0));
            let [x, y, z] = coordinates(&centre, self.template.position_decimals);
            let axes = (tool.axes_of_moment.as_ref())
                .map_or_else(|| "1,0,0,0".to_owned(), |turn| self.quaternion_text(turn));
            let inertia = tool.inertia_kg_m2.unwrap_or_default();
            let [ix, iy, iz] = [inertia.x, inertia.y, inertia.z].map(|value| short(value, 9));
            text += &format!(
                "  PERS tooldata {}:=[TRUE,{},[{mass},[{x},{y},{z}],[{axes}],{ix},{iy},{iz}]];\n",
                name_of_tool(number, tool),
                self.pose(pose)
            );
        }
        let base = &self.template.base;
        if let Some(pose) = base.pose.as_ref().filter(|_| !is_number_zero(base)) {
            let (user, object) = match &base.object_frame {
                None => (*pose, "[[0,0,0],[1,0,0,0]]".to_owned()),
                Some(object) => (pose * object.inverse(), self.pose(object)),
            };
            text += &format!(
                "  PERS wobjdata {}:=[FALSE,TRUE,\"\",{},{object}];\n",
                self.base_name(),
                self.pose(&user)
            );
        }
        let slow = short(self.template.joint_speed_percent * 10.0, 3);
        text += &format!("  CONST speeddata vJoint:=[{slow},{OTHER_SPEEDS}];\n");
        for (data, name) in &self.speeds {
            text += &format!("  CONST speeddata {name}:=[{data}];\n");
        }
        text
    }

    fn base_name(&self) -> String {
        base_name(&self.template.base)
    }

    fn tool_name(&self) -> String {
        let stated = self
            .tool
            .and_then(|number| Some((number, self.template.tools.get(&number)?)));
        match stated {
            Some((number, tool)) => name_of_tool(Some(number), tool),
            None => name_of_tool(None, &self.template.tool),
        }
    }

    fn quaternion_text(&self, turn: &UnitQuaternion<f64>) -> String {
        angles(
            turn,
            OrientationText::Quaternion,
            self.template.quaternion_decimals,
        )
        .join(",")
    }

    fn pose(&self, pose: &Isometry3<f64>) -> String {
        let [x, y, z] = coordinates(&pose.translation.vector, self.template.position_decimals);
        format!("[[{x},{y},{z}],[{}]]", self.quaternion_text(&pose.rotation))
    }

    fn target(
        &self,
        place: &Vector3<f64>,
        turn: &UnitQuaternion<f64>,
        configuration: &str,
    ) -> String {
        let [x, y, z] = coordinates(place, self.template.position_decimals);
        format!(
            "[[{x},{y},{z}],[{}],{configuration},{NO_AXES}]",
            self.quaternion_text(turn)
        )
    }

    fn step(&mut self, step: &Step, text: &mut String) {
        let line = match step {
            Step::Note(note) => format!("! {note}"),
            Step::Action(EventAction::Wait { seconds }) => {
                format!("WaitTime {};", short(*seconds, 6))
            }
            Step::Action(EventAction::Stop | EventAction::OptionalStop) => "Stop;".to_owned(),
            Step::Action(_) => return,
            Step::Statement(text) => text.clone(),
            Step::Tool(number) => {
                self.tool = Some(*number);
                return;
            }
            Step::Motion(motion) => {
                let goes_by = self.goes_by(motion);
                self.follow_configuration(goes_by, text);
                self.motion(motion)
            }
        };
        *text += "    ";
        *text += &line;
        text.push('\n');
    }

    /// True if a motion must end in its stated configuration.
    fn goes_by(&self, motion: &MadeMotion) -> bool {
        let of_template = motion.first && self.template.configuration.is_some();
        let of_source = (motion.configuration.as_ref())
            .is_some_and(|stated| stated.is_followed && stated.end.is_some());
        motion.way == Way::Joint && (of_template || of_source)
    }

    /// `MoveJ` goes to the configuration of its target under `ConfJ\On`, which is the basic setting, and to the one nearest to where the
    /// arm is under `ConfJ\Off`.
    fn follow_configuration(&mut self, follows: bool, text: &mut String) {
        if self.follows_configuration.replace(follows) != Some(follows) {
            *text += match follows {
                true => "    ConfJ\\On;\n",
                false => "    ConfJ\\Off;\n",
            };
        }
    }

    fn motion(&self, motion: &MadeMotion) -> String {
        let turn = motion.orientation.unwrap_or_default();
        let configuration = match (motion.first, &self.template.configuration) {
            (true, Some(configuration)) => configuration,
            _ => motion.end_configuration().unwrap_or(UNKNOWN),
        };
        let end = self.target(&motion.end, &turn, configuration);
        let data = self.speed_of(motion);
        let speed = match (motion.way, self.speeds.get(&data)) {
            (Way::Joint, _) => "vJoint".to_owned(),
            (_, Some(name)) => name.clone(),
            (_, None) => format!("[{data}]"),
        };
        let radius = match motion.rapid {
            true => self.template.zones.rapids_mm,
            false => self.template.zones.feeds_mm,
        };
        let zone = match motion.exact {
            true => "fine".to_owned(),
            false => zone(radius),
        };
        let rest = format!(
            "{speed},{zone},{}\\WObj:={};",
            self.tool_name(),
            self.base_name()
        );
        match motion.way {
            Way::Joint => format!("MoveJ {end},{rest}"),
            Way::Circle {
                via,
                via_orientation,
            } => {
                let stated = motion.via_configuration().unwrap_or(UNKNOWN);
                let via = self.target(&via, &via_orientation.unwrap_or(turn), stated);
                format!("MoveC {via},{end},{rest}")
            }
            _ => format!("MoveL {end},{rest}"),
        }
    }
}

/// True if a motion uses the tool of the template that has no number in the program.
fn uses_tool(steps: &[Step], template: &Template) -> bool {
    let mut is_own = true;
    steps.iter().any(|step| {
        if let Step::Tool(number) = step {
            is_own = !template.tools.contains_key(number);
        }
        is_own && step.motion().is_some()
    })
}

/// A zone by its name, or in line as the named ones are made.
fn zone(radius: f64) -> String {
    match ZONES.iter().find(|zone| **zone == radius) {
        _ if radius == 0.0 => "fine".to_owned(),
        Some(named) if *named < 1.0 => "z0".to_owned(),
        Some(named) => format!("z{}", fixed(*named, 0)),
        None => {
            let [path, half, tenth] =
                [radius, 1.5 * radius, 0.15 * radius].map(|size| short(size, 3));
            format!("[FALSE,{path},{half},{half},{tenth},{half},{tenth}]")
        }
    }
}
