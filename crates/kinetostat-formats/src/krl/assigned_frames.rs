//! Tools and bases that the program itself puts into the arrays of the controller: `TOOL_DATA[4]={X 0,Y 0,Z 180,A 0,B 0,C 0}`.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::ops::Range;

use nalgebra::Isometry3;

use crate::krl::aggregate::Position;
use crate::krl::role::Role;

/// What the program gave frames for certain, as far as it was walked.
#[derive(Debug, Default)]
pub(crate) struct Given {
    /// Elements of the array of a role: the value that the last statement gave for certain; none where it is not in numbers.
    pub numbers: BTreeMap<(Role, u32), Option<Isometry3<f64>>>,
    /// Statements that change elements, as far as they were walked; none where the index is no literal number.
    changes: BTreeMap<(Role, Option<u32>), Changes>,
    /// How many statements had changed an element where it was used first.
    used: RefCell<BTreeMap<(Role, u32), usize>>,
    /// The routine and the line of the statement that is walked.
    pub at: (usize, usize),
    /// The statement that is walked may run several times.
    pub is_repeated: bool,
    /// Data of the program by their index: what statements gave them; none where it is not in numbers, or may not have run.
    pub ends: BTreeMap<usize, Option<GivenEnd>>,
    /// The statement that is walked runs once, on no condition: the values above are those that it finds.
    pub is_certain: bool,
}

/// What statements gave a datum, a frame or another end of a motion.
#[derive(Debug, Clone)]
pub(crate) struct GivenEnd {
    /// Where the last of them stands.
    pub routine: usize,
    pub line: usize,
    /// How many they are.
    pub count: usize,
    pub position: Position,
}

/// Statements by role and number; none where the index is no literal number.
pub(crate) type Assignments = BTreeMap<(Role, Option<u32>), Vec<Assignment>>;

/// Most statements that give one element a value: what has more is taken for one of which nothing is known.
pub(crate) const MOST: usize = 64;

/// A statement that gives an element a value, or may do so.
#[derive(Debug, Clone)]
pub(crate) struct Assignment {
    pub routine: usize,
    pub line: usize,
    /// Tokens of the value; none of a part of it, of an argument of a call, and where the index is no literal number.
    pub value: Option<Range<usize>>,
}

/// Statements that change an element.
#[derive(Debug, Clone, Copy, Default)]
struct Changes {
    count: usize,
    last_line: usize,
    is_repeated: bool,
}

/// What an element is where it is used.
pub(crate) enum Standing {
    /// The same wherever the program uses it.
    One,
    /// What the statement before gave it.
    Held(Isometry3<f64>),
    /// Another one than at other places of the program, with words that tell it from those.
    Apart(String),
}

impl Given {
    /// Notes what the statement that is walked changes.
    pub(crate) fn note_changes(&mut self, assigned: &Assignments) {
        for (element, all) in assigned {
            for _ in all.iter().filter(|one| (one.routine, one.line) == self.at) {
                let changes = self.changes.entry(*element).or_default();
                changes.count += 1;
                changes.last_line = self.at.1;
                changes.is_repeated |= self.is_repeated;
            }
        }
    }

    fn changes(&self, role: Role, number: u32) -> Changes {
        let both = [Some(number), None].map(|number| self.changes.get(&(role, number)).copied());
        let [own, any] = both.map(Option::unwrap_or_default);
        Changes {
            count: own.count + any.count,
            last_line: own.last_line.max(any.last_line),
            is_repeated: own.is_repeated || any.is_repeated,
        }
    }

    /// What an element is in the statement that is walked, where `values` are the numbers that statements give it: a controller takes a
    /// frame as it is when `$BASE=BASE_DATA[1]` runs, so that two values of one element are two frames.
    pub(crate) fn standing(
        &self,
        (role, number): (Role, u32),
        assigned: &Assignments,
        value: impl Fn(&Assignment) -> Option<Isometry3<f64>>,
    ) -> Standing {
        let all: Vec<&Assignment> = of_element(assigned, (role, number)).collect();
        let changes = self.changes(role, number);
        let first = *(self.used.borrow_mut().entry((role, number))).or_insert(changes.count);
        // All statements ran before it is used at all: it has the value that the last of them left.
        let is_settled = changes.count >= all.len() && first == changes.count;
        if all.is_empty() || (is_settled && !changes.is_repeated) {
            return Standing::One;
        }
        if self.is_repeated && changes.count < all.len() {
            return Standing::Apart(format!("(of line {})", self.at.1));
        }
        let of_first = all.first().and_then(|first| value(first));
        let is_one = of_first.is_some() && all.iter().all(|other| value(other) == of_first);
        if is_one && first == changes.count {
            return Standing::One;
        }
        let is_here = all.iter().all(|one| one.routine == self.at.0) && self.is_certain;
        match (is_here, changes.count) {
            (true, 0) => Standing::One,
            (true, _) => match self.held((role, number), &all, value) {
                Some(frame) => Standing::Held(frame),
                None => Standing::Apart(format!("(since line {})", changes.last_line)),
            },
            (false, _) => Standing::Apart(format!("(of line {})", self.at.1)),
        }
    }

    /// What the statement before gave an element, in numbers and for certain.
    pub(crate) fn held(
        &self,
        element: (Role, u32),
        all: &[&Assignment],
        value: impl Fn(&Assignment) -> Option<Isometry3<f64>>,
    ) -> Option<Isometry3<f64>> {
        let is_followed = |one: &&Assignment| one.routine == self.at.0 && value(one).is_some();
        let is_certain = self.is_certain && all.iter().all(is_followed);
        *self.numbers.get(&element).filter(|_| is_certain)?
    }
}

/// The statements that give an element a value, or may do so.
pub(crate) fn of_element(
    assigned: &Assignments,
    (role, number): (Role, u32),
) -> impl Iterator<Item = &Assignment> {
    let of = move |number: Option<u32>| assigned.get(&(role, number));
    of(Some(number)).into_iter().chain(of(None)).flatten()
}
