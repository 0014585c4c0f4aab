//! What is left of a stock while the tool goes along the program.

use kinetostat_cutting::{Probe, Result, Stock};
use kinetostat_program::{Curve, Knowledge, Move, MoveKind, Path};

use crate::cut::question::{CutQuestion, EngagementSource};
use crate::cut::walk::CHORD;

/// A stock and the tools that go through it. It remembers how far it was asked last, so that going on costs what lies between.
#[derive(Clone, Debug)]
pub struct StockAlong {
    whole: Stock,
    left: Stock,
    probes: Vec<Probe>,
    /// Moves that remove material, each with its tool.
    moves: Vec<Option<(usize, Move)>>,
    /// Moves that `left` has behind it.
    done: usize,
}

impl StockAlong {
    /// The stock of a question along a path; `None` where the engagement comes from no stock.
    #[must_use]
    pub fn of(question: &CutQuestion, path: &Path) -> Option<Self> {
        let EngagementSource::Stock(stock) = &question.engagement else {
            return None;
        };
        let swept = |motion: &Move| {
            let tool = question.tool_on(path, motion.line);
            // Without a known tool nothing is known to be swept by a rapid; what cuts is taken as the first tool.
            let tool = match motion.kind {
                MoveKind::Rapid => tool.ok()?,
                _ => tool.unwrap_or(0),
            };
            let moves = motion.known == Knowledge::Whole && motion.has_length();
            moves.then(|| (tool, motion.clone()))
        };
        Some(Self {
            whole: (**stock).clone(),
            left: (**stock).clone(),
            probes: question
                .tools
                .iter()
                .map(|tool| Probe::new(&tool.tool))
                .collect(),
            moves: path.moves.iter().map(swept).collect(),
            done: 0,
        })
    }

    /// What is left when the tool has come to a share of a move, by its index in the path.
    ///
    /// # Errors
    /// A place beyond 100 m.
    pub fn at(&mut self, index: usize, share: f64) -> Result<Stock> {
        if index < self.done {
            self.left = self.whole.clone();
            self.done = 0;
        }
        while self.done < index.min(self.moves.len()) {
            if let Some((tool, motion)) = &self.moves[self.done] {
                sweep(&mut self.probes[*tool], &mut self.left, motion, 1.0)?;
            }
            self.done += 1;
        }
        let mut left = self.left.clone();
        if let Some(Some((tool, motion))) = self.moves.get(index) {
            sweep(&mut self.probes[*tool], &mut left, motion, share)?;
        }
        Ok(left)
    }
}

/// Removes what a tool sweeps on a move up to a share of it.
fn sweep(probe: &mut Probe, stock: &mut Stock, motion: &Move, share: f64) -> Result<()> {
    let chords = match &motion.curve {
        Curve::Line => 1,
        Curve::Arc(arc) => arc.chords_within(CHORD * stock.cell_mm()),
    };
    let at = |i: usize| motion.point(share * i as f64 / chords as f64).into();
    let places: Vec<[f64; 3]> = (0..=chords).map(at).collect();
    probe.cut_along(stock, &places)
}
