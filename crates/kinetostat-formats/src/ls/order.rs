//! The order in which motions first run, over all programs.

use crate::ls::program::{Place, Program};
use crate::ls::step::Step;
use crate::model::motion::Runs;

/// The motions in the order in which they first run, and how often each program runs.
pub(crate) struct Order {
    pub motions: Vec<Place>,
    pub runs: Vec<Runs>,
}

/// Deepest nesting of calls that is followed.
const DEEPEST: usize = 200;

impl Order {
    /// Of programs, the first of which is started.
    pub(crate) fn of(programs: &[Program]) -> Self {
        let mut order = Self {
            motions: Vec::new(),
            runs: vec![Runs::Elsewhere; programs.len()],
        };
        let (mut begun, mut finished) = (vec![false; programs.len()], Vec::new());
        for root in 0..programs.len() {
            if !begun[root] {
                order.visit(root, programs, &mut begun, &mut finished, 0);
            }
        }
        // Callers first; a program that calls itself, or is called by what it calls, runs repeatedly.
        let mut calls: Vec<Vec<(usize, Runs)>> = vec![Vec::new(); programs.len()];
        let mut place = vec![0; programs.len()];
        for (at, program) in finished.iter().enumerate() {
            place[*program] = at;
        }
        for (from, program) in programs.iter().enumerate() {
            for (at, to) in &program.called {
                let perhaps = matches!(program.steps[*at], Step::Perhaps(_));
                let runs = match perhaps {
                    true => Runs::OnCondition.max(program.runs[*at]),
                    false => program.runs[*at],
                };
                calls[*to].push((from, runs));
            }
        }
        for program in finished.iter().rev().copied() {
            let reached = calls[program].iter();
            let recursive = calls[program]
                .iter()
                .any(|(from, _)| place[*from] <= place[program]);
            let mut reached = reached
                .filter(|(from, _)| order.runs[*from] != Runs::Elsewhere)
                .map(|(from, runs)| order.runs[*from].max(*runs));
            order.runs[program] = match (reached.next(), reached.next()) {
                _ if recursive => Runs::Repeatedly,
                (None, _) if program == 0 => Runs::Once,
                (None, _) => Runs::Elsewhere,
                (Some(once), None) if program != 0 => once,
                _ => Runs::Repeatedly,
            };
        }
        order
    }

    fn visit(
        &mut self,
        program: usize,
        programs: &[Program],
        begun: &mut [bool],
        finished: &mut Vec<usize>,
        depth: usize,
    ) {
        begun[program] = true;
        for (at, step) in programs[program].steps.iter().enumerate() {
            match step {
                Step::Motion(_) => self.motions.push((program, at)),
                Step::Call(_) | Step::Perhaps(_) => {
                    if let Some(to) = programs[program].called.get(&at)
                        && !begun[*to]
                        && depth < DEEPEST
                    {
                        self.visit(*to, programs, begun, finished, depth + 1);
                    }
                }
                _ => {}
            }
        }
        finished.push(program);
    }
}
