//! Speeds that the program assigns: `rdkSpeed.v_tcp:=20;` and `rdkSpeed:=[20,500,5000,1000];` before the motions that go with them.

use std::ops::Range;

use crate::model::motion::Runs;
use crate::rapid::expression::expression_of;
use crate::rapid::lex::Kind;
use crate::rapid::symbols::Meaning;
use crate::rapid::tree::Change;
use crate::rapid::walker::Walker;
use crate::text::name::Name;

/// The parts of a speed: of the tip, of turning, of external axes that go straight and that turn.
const PARTS: [&str; 4] = ["V_TCP", "V_ORI", "V_LEAX", "V_REAX"];

impl Walker<'_, '_> {
    /// The statement that is walked finds what was given before for certain, or not.
    pub(super) fn speeds_are_certain(&mut self) {
        self.values.assigned_speeds.is_certain = self.now.runs == Runs::Once;
    }

    /// The program begins: what nothing has assigned has the value of its declaration.
    pub(super) fn speeds_begin(&mut self) {
        for index in 0..self.values.symbols.data.len() {
            let datum = &self.values.symbols.data[index];
            let is_first = datum.node.change == Change::Variable && datum.assigned.is_some();
            if is_first && datum.node.type_name.is("SPEEDDATA") {
                let first = self.values.first_speed(index);
                self.values.assigned_speeds.held.insert(index, first);
            }
        }
    }

    /// A routine runs, or has run, which may have assigned them.
    pub(super) fn speeds_of_call(&mut self, called: usize) {
        let symbols = &self.values.symbols;
        let held = &mut self.values.assigned_speeds.held;
        held.retain(|index, _| {
            symbols.data[*index]
                .assigned_in
                .is_some_and(|own| own != called)
        });
    }

    /// What a speed holds for certain where nothing but that of the tip is assigned; the latter as it is declared.
    fn speed_beside_tip(&self, index: usize) -> Option<[f64; 4]> {
        let datum = &self.values.symbols.data[index];
        let is_first = datum.node.change == Change::Variable && !datum.is_changed_otherwise;
        let is_first = is_first && !datum.is_assigned_beside_tip;
        is_first.then(|| self.values.first_speed(index)).flatten()
    }

    /// `s:=[200,500,5000,1000];` and `s.v_tcp:=20;`.
    pub(super) fn assigns_speed(&mut self, tokens: &Range<usize>, assign: usize) {
        let file = self.file();
        let routine = self.now.routine;
        let name = Name::of(file.word(tokens.start));
        let meaning = name.and_then(|name| self.values.symbols.meaning(routine, &name));
        let Some(Meaning::Datum(index)) = meaning else {
            return;
        };
        if !self.values.symbols.data[index]
            .node
            .type_name
            .is("SPEEDDATA")
        {
            return;
        }
        let end = tokens.end.saturating_sub(1).max(assign + 1);
        let value = expression_of(file, assign + 1..end);
        let place = tokens.start + 1..assign;
        let is_part = file.tokens[place.start].kind == Kind::Symbol(b'.') && place.len() == 2;
        let found = match (place.is_empty(), is_part) {
            (true, _) => self.values.speed(routine, &value),
            (false, true) => {
                let part = Name::of(file.word(place.start + 1));
                let at = part.and_then(|part| PARTS.iter().position(|name| part.is(name)));
                let before = self
                    .values
                    .assigned_speeds
                    .held
                    .get(&index)
                    .copied()
                    .flatten();
                let before = before.or_else(|| self.speed_beside_tip(index));
                let number = self.values.number(routine, &value);
                at.zip(before).zip(number).map(|((at, mut all), number)| {
                    all[at] = number;
                    all
                })
            }
            (false, false) => None,
        };
        let is_certain = self.now.runs == Runs::Once;
        let held = &mut self.values.assigned_speeds.held;
        held.insert(index, found.filter(|_| is_certain));
    }
}
