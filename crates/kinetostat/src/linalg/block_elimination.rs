//! Elimination block by block for systems of many platforms.
//!
//! Blocks are eliminated in the order of fewest neighbours, so that a tree or a lattice of platforms
//! stays sparse. A block that cannot be eliminated soundly (singular, or the elimination would
//! magnify rounding) is not replaced or perturbed: it joins a neighbour and is tried again with it
//! (delayed pivots), in the end as one dense block. A system whose rank is not certain has no
//! factors here; the caller decides on the dense matrix.

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::{DMatrix, Dyn, LU};

use crate::linalg::saddle::{Inertia, RANK_TOLERANCE};
use crate::linalg::sparse::Sparse;
use crate::number::{larger, largest_size, smaller};

/// Blocks that may be eliminated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pivots {
    /// Regular ones that do not magnify.
    Any,
    /// All: the matrix is positive definite, as badly conditioned as it may be.
    Definite,
}

/// An elimination may magnify rounding this much; one step of refinement takes it out.
const GROWTH: f64 = 1e4;

struct EliminationStep {
    own: Vec<usize>,
    outer: Vec<usize>,
    pivot: DMatrix<f64>,
    factors: LU<f64, Dyn, Dyn>,
    /// `D^-1 A[own, outer]`.
    upper: DMatrix<f64>,
    /// `A[outer, own]`.
    lower: DMatrix<f64>,
}

/// A factorised system.
pub struct BlockFactors {
    units: Vec<f64>,
    /// Scaled.
    matrix: Sparse,
    steps: Vec<EliminationStep>,
}

/// Blocks not yet eliminated.
struct Active {
    /// Unknowns of every block; empty once eliminated.
    members: Vec<Vec<usize>>,
    /// Rows by blocks; structurally symmetric.
    rows: Vec<BTreeMap<usize, DMatrix<f64>>>,
    /// Unknowns coupled, and block: the next one first.
    queue: BTreeSet<(usize, usize)>,
    cost: Vec<usize>,
}

impl Active {
    fn new(matrix: &Sparse, nodes: &[usize]) -> Self {
        let count = nodes.iter().max().map_or(0, |most| most + 1);
        // An unknown without any entry is zero.
        let mut used = vec![false; nodes.len()];
        for &(i, j, _) in &matrix.entries {
            (used[i], used[j]) = (true, true);
        }
        let mut members = vec![Vec::new(); count];
        let mut place = vec![0; nodes.len()];
        for (i, &node) in nodes.iter().enumerate().filter(|(i, _)| used[*i]) {
            place[i] = members[node].len();
            members[node].push(i);
        }
        let mut own = Self {
            rows: vec![BTreeMap::new(); count],
            queue: BTreeSet::new(),
            cost: vec![0; count],
            members,
        };
        for &(i, j, value) in &matrix.entries {
            own.block(nodes[i], nodes[j])[(place[i], place[j])] += value;
            if nodes[i] != nodes[j] {
                own.block(nodes[j], nodes[i]);
            }
        }
        for node in 0..count {
            if !own.members[node].is_empty() {
                own.block(node, node);
                own.queue.insert((0, node));
                own.recount(node);
            }
        }
        own
    }

    fn block(&mut self, row: usize, column: usize) -> &mut DMatrix<f64> {
        let shape = (self.members[row].len(), self.members[column].len());
        self.rows[row]
            .entry(column)
            .or_insert_with(|| DMatrix::zeros(shape.0, shape.1))
    }

    fn neighbours(&self, node: usize) -> Vec<usize> {
        let all = self.rows[node].keys().copied();
        all.filter(|&other| other != node).collect()
    }

    fn recount(&mut self, node: usize) {
        let all = self.rows[node].keys();
        let cost = all.map(|&other| self.members[other].len()).sum();
        self.queue.remove(&(self.cost[node], node));
        self.cost[node] = cost;
        self.queue.insert((cost, node));
    }

    /// Factors of a block, or none if it must wait.
    fn step(&self, node: usize, pivots: Pivots, most: f64) -> Option<EliminationStep> {
        let neighbours = self.neighbours(node);
        let own = self.members[node].clone();
        let outer: Vec<usize> = neighbours
            .iter()
            .flat_map(|&other| self.members[other].iter().copied())
            .collect();
        let mut upper = DMatrix::zeros(own.len(), outer.len());
        let mut lower = DMatrix::zeros(outer.len(), own.len());
        let mut at = 0;
        for &other in &neighbours {
            let k = self.members[other].len();
            upper.columns_mut(at, k).copy_from(&self.rows[node][&other]);
            lower.rows_mut(at, k).copy_from(&self.rows[other][&node]);
            at += k;
        }
        let pivot = self.rows[node][&node].clone();
        let factors = pivot.clone().lu();
        match pivots {
            Pivots::Definite => {
                pivot.clone().cholesky()?;
            }
            Pivots::Any => {
                let (least, own) = range(&factors);
                let most = most.max(own);
                if least.is_nan() || least <= 10.0 * RANK_TOLERANCE * most {
                    return None;
                }
            }
        }
        if !factors.solve_mut(&mut upper) {
            return None;
        }
        let sound = pivots == Pivots::Definite || upper.iter().all(|x| x.abs() <= GROWTH);
        sound.then_some(EliminationStep {
            own,
            outer,
            pivot,
            factors,
            upper,
            lower,
        })
    }

    /// Takes a factorised block out.
    fn eliminate(&mut self, node: usize, step: &EliminationStep) {
        let neighbours = self.neighbours(node);
        let update = &step.lower * &step.upper;
        let mut row = 0;
        for &i in &neighbours {
            let mut column = 0;
            let height = self.members[i].len();
            for &j in &neighbours {
                let width = self.members[j].len();
                *self.block(i, j) -= update.view((row, column), (height, width));
                column += width;
            }
            self.rows[i].remove(&node);
            row += height;
        }
        self.rows[node].clear();
        self.members[node].clear();
        for other in neighbours {
            self.recount(other);
        }
    }

    /// Puts a block that must wait into its neighbour of fewest unknowns; false if it has none.
    fn join(&mut self, node: usize) -> bool {
        let neighbours = self.neighbours(node);
        let Some(&into) = neighbours.iter().min_by_key(|&&other| self.cost[other]) else {
            return false;
        };
        let (first, more) = (self.members[into].len(), self.members[node].len());
        let row = std::mem::take(&mut self.rows[node]);
        let mut columns: BTreeMap<usize, DMatrix<f64>> = BTreeMap::new();
        for &other in &neighbours {
            if let Some(column) = self.rows[other].remove(&node) {
                columns.insert(other, column);
            }
        }
        let moved = std::mem::take(&mut self.members[node]);
        self.members[into].extend(moved);
        let size = first + more;
        // Diagonal block of the two together.
        let mut own = DMatrix::zeros(size, size);
        own.view_mut((0, 0), (first, first))
            .copy_from(&self.rows[into][&into]);
        own.view_mut((first, first), (more, more))
            .copy_from(&row[&node]);
        own.view_mut((first, 0), (more, first))
            .copy_from(&row[&into]);
        own.view_mut((0, first), (first, more))
            .copy_from(&columns[&into]);
        let others: BTreeSet<usize> = neighbours
            .iter()
            .copied()
            .chain(self.neighbours(into))
            .filter(|&other| other != into)
            .collect();
        for &other in &others {
            let width = self.members[other].len();
            let mut upper = DMatrix::zeros(size, width);
            let mut lower = DMatrix::zeros(width, size);
            if let Some(block) = self.rows[into].get(&other) {
                upper.rows_mut(0, first).copy_from(block);
                lower
                    .columns_mut(0, first)
                    .copy_from(&self.rows[other][&into]);
            }
            if let Some(block) = row.get(&other) {
                upper.rows_mut(first, more).copy_from(block);
                lower.columns_mut(first, more).copy_from(&columns[&other]);
            }
            self.rows[into].insert(other, upper);
            self.rows[other].insert(into, lower);
        }
        self.rows[into].insert(into, own);
        for other in others.into_iter().chain([into]) {
            self.recount(other);
        }
        true
    }
}

/// Smallest and largest pivot.
fn range(factors: &LU<f64, Dyn, Dyn>) -> (f64, f64) {
    let pivots = factors.lu_internal().diagonal();
    pivots.iter().fold((f64::INFINITY, 0.0_f64), |(l, m), p| {
        let size = p.abs();
        (
            if size < l || size.is_nan() { size } else { l },
            m.max(size),
        )
    })
}

impl BlockFactors {
    /// Factorises `diag(units) A diag(units)`, unknowns gathered to blocks by `nodes`; `None` if it
    /// is singular or nearly so.
    pub fn new(a: &Sparse, nodes: &[usize], units: &[f64], pivots: Pivots) -> Option<Self> {
        let mut matrix = a.clone();
        for (i, j, value) in &mut matrix.entries {
            *value *= units[*i] * units[*j];
        }
        let mut active = Active::new(&matrix, nodes);
        let mut steps: Vec<EliminationStep> = Vec::new();
        let (mut least, mut most) = (f64::INFINITY, 0.0_f64);
        while let Some((_, node)) = active.queue.pop_first() {
            match active.step(node, pivots, most) {
                Some(step) => {
                    let (low, high) = range(&step.factors);
                    (least, most) = (least.min(low), most.max(high));
                    active.eliminate(node, &step);
                    steps.push(step);
                }
                None if pivots == Pivots::Definite || !active.join(node) => return None,
                None => {}
            }
        }
        let regular = pivots == Pivots::Definite || least > 10.0 * RANK_TOLERANCE * most;
        (regular || steps.is_empty()).then(|| Self {
            units: units.to_vec(),
            matrix,
            steps,
        })
    }

    /// Solves for all columns of `b`, in place, with one step of refinement.
    pub fn solve(&self, b: &mut DMatrix<f64>) {
        for mut column in b.column_iter_mut() {
            for (x, unit) in column.iter_mut().zip(&self.units) {
                *x *= unit;
            }
        }
        let mut x = self.once(b);
        let rest = &*b - self.matrix.times(&x);
        x += self.once(&rest);
        for mut column in x.column_iter_mut() {
            for (x, unit) in column.iter_mut().zip(&self.units) {
                *x *= unit;
            }
        }
        *b = x;
    }

    /// Scaled, without refinement.
    fn once(&self, b: &DMatrix<f64>) -> DMatrix<f64> {
        let mut work = b.clone();
        let mut x = DMatrix::zeros(b.nrows(), b.ncols());
        for step in &self.steps {
            let mut own = work.select_rows(&step.own);
            // The pivots were checked.
            let solved = step.factors.solve_mut(&mut own);
            debug_assert!(solved);
            let change = &step.lower * &own;
            for (row, &i) in change.row_iter().zip(&step.outer) {
                let mut target = work.row_mut(i);
                target -= row;
            }
            for (row, &i) in own.row_iter().zip(&step.own) {
                x.row_mut(i).copy_from(&row);
            }
        }
        for step in self.steps.iter().rev() {
            let change = &step.upper * x.select_rows(&step.outer);
            for (row, &i) in change.row_iter().zip(&step.own) {
                let mut target = x.row_mut(i);
                target -= row;
            }
        }
        x
    }

    /// Inertia of a symmetric system, the sum of those of its blocks (Haynsworth), and the smallest
    /// of their eigenvalues as a share of the largest: where that is at rounding, signs may be wrong
    /// by an eigenvalue of that share.
    pub fn inertia(&self) -> (Inertia, f64) {
        let values: Vec<f64> = self
            .steps
            .iter()
            .flat_map(|step| {
                let symmetric = 0.5 * (&step.pivot + step.pivot.transpose());
                let values = symmetric.symmetric_eigenvalues();
                values.iter().copied().collect::<Vec<f64>>()
            })
            .collect();
        let most = largest_size(&values);
        let least = values.iter().fold(most, |m, v| smaller(m, v.abs()));
        let count = |positive: bool| values.iter().filter(|v| (**v > 0.0) == positive).count();
        let inertia = Inertia {
            positive: count(true),
            negative: count(false),
            zero: 0,
        };
        (inertia, least / larger(most, f64::MIN_POSITIVE))
    }
}

/// Dense matrices are faster for this many moving platforms and fewer.
pub(crate) const FEW: usize = 10;
