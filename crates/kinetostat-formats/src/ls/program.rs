//! The instructions of a program: its blocks and its labels.

use std::collections::BTreeMap;

use crate::interpreter::expression::Node;
use crate::ls::step::Step;

/// A program's instructions, and where its blocks and jumps lead.
pub(crate) struct Program {
    pub steps: Vec<Step>,
    /// From IF behind its ELSE or to ENDIF, from ELSE to ENDIF, from FOR behind ENDFOR, from ENDFOR to FOR.
    pub leads: BTreeMap<usize, usize>,
    pub labels: BTreeMap<u32, usize>,
    /// Instructions that fit nothing: where, why, what to do.
    pub faults: Vec<(usize, &'static str, &'static str)>,
}

impl Program {
    /// Finds the ends of blocks and the labels.
    pub(crate) fn of(steps: Vec<Step>) -> Self {
        let mut program = Self {
            leads: BTreeMap::new(),
            labels: BTreeMap::new(),
            faults: Vec::new(),
            steps,
        };
        program.blocks();
        program
    }

    /// ENDIF of the block that IF begins.
    pub(crate) fn end_of_if(&self, at: usize) -> usize {
        let lead = self.leads.get(&at).copied().unwrap_or(at + 1);
        match lead.checked_sub(1) {
            Some(before) if before > at && self.steps[before] == Step::Else => {
                self.leads.get(&before).copied().unwrap_or(lead)
            }
            _ => lead,
        }
    }

    fn blocks(&mut self) {
        const ALONE: (&str, &str) = (
            "the block that it belongs to is not whole",
            "close IF with ENDIF and FOR with ENDFOR",
        );
        let mut open: Vec<(usize, bool)> = Vec::new();
        for at in 0..self.steps.len() {
            match &self.steps[at] {
                Step::Label(number) => {
                    let before = self.labels.insert(*number, at);
                    let twice = "there is a label of this number above";
                    let fault = before.map(|_| (at, twice, "number it otherwise"));
                    self.faults.extend(fault);
                }
                Step::If(_) | Step::For(_) => open.push((at, false)),
                Step::Else | Step::EndIf => match open.pop() {
                    Some((from, has_else))
                        if matches!(self.steps[from], Step::If(_) | Step::Else) =>
                    {
                        let is_else = self.steps[at] == Step::Else;
                        if is_else && has_else {
                            self.faults.push((at, ALONE.0, ALONE.1));
                        }
                        // IF leads behind ELSE or to ENDIF; ELSE, reached from above, to ENDIF.
                        self.leads.insert(from, at + usize::from(is_else));
                        if is_else {
                            open.push((at, true));
                        }
                    }
                    _ => self.faults.push((at, ALONE.0, ALONE.1)),
                },
                Step::EndFor => match open.pop() {
                    Some((from, _)) if matches!(self.steps[from], Step::For(_)) => {
                        self.leads.insert(from, at + 1);
                        self.leads.insert(at, from);
                    }
                    _ => self.faults.push((at, ALONE.0, ALONE.1)),
                },
                _ => {}
            }
        }
        for (at, _) in open {
            self.faults.push((at, ALONE.0, ALONE.1));
        }
        for (at, step) in self.steps.iter().enumerate() {
            let is_lost = |step: &Step| match step {
                Step::Jump(index) => {
                    label_of(&index.node).is_some_and(|to| !self.labels.contains_key(&to))
                }
                _ => false,
            };
            if is_lost(step.action()) {
                let reason = "there is no such label in the program";
                self.faults
                    .push((at, reason, "write the label, or take the jump out"));
            }
        }
    }
}

/// The number of a label that is stated.
pub(crate) fn label_of(index: &Node) -> Option<u32> {
    match index {
        Node::Number(number) if number.fract() == 0.0 && *number >= 0.0 => Some(*number as u32),
        _ => None,
    }
}
