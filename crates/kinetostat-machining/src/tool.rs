//! The tools of a program, each with its own machine and load.

use kinetostat::Mechanism;
use kinetostat::batch::AlongPath;
use kinetostat_program::Path;

use crate::load::ProgramLoad;
use crate::run::Task;
use crate::sites::Site;
use crate::solve::Orientation;

/// A tool of the machine's magazine.
///
/// The tool is a part of the machine: its length is in the mechanism, whose platform's reference point is
/// the tool's tip ([`Mechanism::with_tool`]).
#[derive(Clone, Copy, Debug)]
pub struct Tool<'a> {
    /// Number in the program's T words.
    pub number: u32,
    /// Machine with this tool.
    pub mechanism: &'a Mechanism,
    /// What acts on this tool.
    pub load: ProgramLoad,
}

/// The tool that the block on a line is made with; `None` where the program names none of these.
pub(crate) fn tool_on<'t, 'a>(
    tools: &'t [Tool<'a>],
    path: &Path,
    line: usize,
) -> Option<&'t Tool<'a>> {
    if tools.is_empty() {
        return None;
    }
    let number = path.tool_on(line)?;
    tools.iter().find(|tool| tool.number == number)
}

/// The machine of a run with each of its tools, ready to solve many postures.
pub(crate) struct Machines<'t, 'm> {
    task: &'t Task<'m>,
    /// The first is the machine without one of the tools.
    machines: Vec<AlongPath<'m>>,
}

impl<'t, 'm> Machines<'t, 'm> {
    pub fn new(task: &'t Task<'m>) -> Self {
        let machine = match task.placement.orientation_follows {
            true => AlongPath::by_neighbours,
            false => AlongPath::new,
        };
        let machines = std::iter::once(task.mechanism);
        let machines = machines.chain(task.tools.iter().map(|tool| tool.mechanism));
        Self {
            task,
            machines: machines.map(machine).collect(),
        }
    }

    fn tool(&self, site: &Site) -> Option<&'t Tool<'m>> {
        tool_on(self.task.tools, self.task.path, site.line)
    }

    /// Whether two places are cut with one tool.
    pub fn same(&self, one: &Site, other: &Site) -> bool {
        let number = |site: &Site| self.tool(site).map(|tool| tool.number);
        number(one) == number(other)
    }

    /// The machine that cuts at a place, and what is done with the orientation there.
    pub fn at(&self, site: &Site) -> (&AlongPath<'m>, Orientation) {
        let tool = self.tool(site);
        let position = |tool: &Tool<'_>| {
            let own = |other: &Tool<'_>| other.number == tool.number;
            self.task.tools.iter().position(own)
        };
        let index = tool.and_then(position).map_or(0, |index| index + 1);
        let load = tool.map_or(&self.task.load, |tool| &tool.load);
        let orientation = Orientation::of(&self.task.placement, load);
        (&self.machines[index], orientation)
    }
}
