//! What names are worth: data with one value, numbers, the members of inline forms' data, and what the caller states.

use std::collections::BTreeMap;
use std::ops::Range;

use nalgebra::Isometry3;

use crate::krl::aggregate::{Aggregate, aggregate_of, number_of};
use crate::krl::lex::TokenFile;
use crate::krl::symbols::{Datum, Meaning, Stated, Symbols};
use crate::krl::usage::place_of;
use crate::options::ReadOptions;
use crate::text::name::Name;

/// Why something is refused, and what to do.
pub(crate) type Reason = (String, &'static str);

pub(crate) const WRITE_IT: &str =
    "write the motion with a literal or a target of the .dat, or leave it as written when reading";

/// What a FDAT states.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PointData {
    pub tool: Option<u32>,
    pub base: Option<u32>,
    /// The tool stands still and the part is in the hand.
    pub is_external: bool,
}

/// Files, names, and what the caller states.
pub(crate) struct Values<'p> {
    pub files: &'p [TokenFile<'p>],
    pub symbols: Symbols<'p>,
    pub stated: BTreeMap<String, Isometry3<f64>>,
}

/// A name as the caller may write it: without blanks, in capitals.
pub(crate) fn key(name: &str) -> String {
    let letters = name.chars().filter(|letter| !letter.is_whitespace());
    letters.collect::<String>().to_uppercase()
}

impl<'p> Values<'p> {
    pub(crate) fn new(
        files: &'p [TokenFile<'p>],
        symbols: Symbols<'p>,
        options: &ReadOptions,
    ) -> Self {
        let stated = options
            .frames
            .iter()
            .map(|(name, frame)| (key(name), *frame))
            .collect();
        Self {
            files,
            symbols,
            stated,
        }
    }

    /// The file of a routine.
    pub(crate) fn file(&self, routine: usize) -> &'p TokenFile<'p> {
        &self.files[self.symbols.routines[routine].file]
    }

    /// The datum that a name or an element is, with its one value; why it has none.
    pub(crate) fn datum(
        &self,
        routine: usize,
        tokens: &Range<usize>,
    ) -> Result<(&Datum, &Stated), Reason> {
        let file = self.file(routine);
        let computed = || {
            (
                "where it goes is computed while the program runs".to_owned(),
                WRITE_IT,
            )
        };
        let name = file.name(tokens.start).ok_or_else(computed)?;
        let (place, element) = place_of(file, tokens.start, tokens.end);
        let element = element.ok_or_else(computed)?;
        if place != *tokens {
            return Err(computed());
        }
        let shown = file.text(&(tokens.start..tokens.start + 1));
        let index = match self.symbols.meaning(routine, &name) {
            Some(Meaning::Datum(index)) => index,
            Some(Meaning::Parameter) => {
                let reason = format!(
                    "`{shown}` is an argument of the routine: it differs from call to call"
                );
                return Err((
                    reason,
                    "write the motion where the routine is called, with its target",
                ));
            }
            None if shown.starts_with('$') => return Err(computed()),
            None => {
                let reason = format!("no `{shown}` is declared in these files");
                return Err((
                    reason,
                    "give the .dat file that declares it as well (or $config.dat)",
                ));
            }
        };
        let datum = &self.symbols.data[index];
        let stated = datum.stated.get(&element);
        let place = |at: usize| match at == file.index {
            true => String::new(),
            false => format!("{}, ", self.files[at].source.name()),
        };
        if let Some((at, line)) = datum.assigned.or(stated.and_then(|stated| stated.assigned)) {
            let place = place(at);
            return Err((
                format!("`{shown}` is changed while the program runs ({place}line {line})"),
                WRITE_IT,
            ));
        }
        match (stated, datum.elements_assigned.get(&element)) {
            (Some(stated), _) => Ok((datum, stated)),
            (None, Some((at, line))) => Err((
                format!(
                    "`{}` gets its value while the program runs ({}line {line}), and values that a program assigns are not followed",
                    file.text(tokens),
                    place(*at)
                ),
                WRITE_IT,
            )),
            (None, None) => Err((
                format!("`{}` has no value in these files", file.text(tokens)),
                "give the .dat file that states it as well",
            )),
        }
    }

    /// Whether a name is declared in none of the files, as home positions of the controller are: its `$config.dat` has XHOME.
    pub(crate) fn is_elsewhere(&self, routine: usize, tokens: &Range<usize>) -> bool {
        let name = self.file(routine).name(tokens.start);
        let name = name.filter(|_| tokens.len() == 1);
        let is_own = |name: &Name| !name.letters().starts_with(b"$") || name.is("$H_POS");
        name.is_some_and(|name| is_own(&name) && self.symbols.meaning(routine, &name).is_none())
    }

    /// The members of a value in braces, or of a datum.
    fn members(
        &self,
        routine: usize,
        tokens: &Range<usize>,
    ) -> Result<(&TokenFile<'p>, Option<Aggregate>), Reason> {
        let own = self.file(routine);
        let (file, value) = match own.is(tokens.start, b'{') {
            true => (own, tokens),
            false => {
                let (datum, stated) = self.datum(routine, tokens)?;
                (&self.files[datum.file], &stated.value)
            }
        };
        Ok((file, aggregate_of(file, value)))
    }

    /// What a FDAT states.
    pub(crate) fn point_data(&self, routine: usize, tokens: &Range<usize>) -> Option<PointData> {
        let (file, members) = self.members(routine, tokens).ok()?;
        let members = members?;
        let number = |name: &str| {
            let value = members.number(file, name)?;
            ((0.0..1e6).contains(&value) && value.fract() == 0.0).then_some(value as u32)
        };
        let mode = members.member("IPO_FRAME").map(|tokens| file.text(tokens));
        Some(PointData {
            tool: number("TOOL_NO"),
            base: number("BASE_NO"),
            is_external: mode.is_some_and(|mode| mode.trim().eq_ignore_ascii_case("#TCP")),
        })
    }

    /// A member of a LDAT as it is written, without its `#`, in capitals; none where it states none.
    pub(crate) fn choice(
        &self,
        routine: usize,
        tokens: &Range<usize>,
        capitals: &str,
    ) -> Result<Option<String>, Reason> {
        let (file, members) = self.members(routine, tokens)?;
        let member = members.and_then(|members| members.member(capitals).cloned());
        let text = member.map(|tokens| file.text(&tokens).to_uppercase());
        Ok(text.map(|text| text.trim_start_matches('#').trim().to_owned()))
    }

    /// A number of a LDAT or PDAT.
    pub(crate) fn member(
        &self,
        routine: usize,
        tokens: &Range<usize>,
        capitals: &str,
    ) -> Option<f64> {
        let (file, members) = self.members(routine, tokens).ok()?;
        members?.number(file, capitals)
    }

    /// A number, a quotient of numbers, or a constant of that name.
    pub(crate) fn number(&self, routine: usize, tokens: &Range<usize>) -> Option<f64> {
        let file = self.file(routine);
        if let Some(slash) = file.find(tokens.clone(), b'/') {
            let above = number_of(file, &(tokens.start..slash))?;
            let quotient = above / number_of(file, &(slash + 1..tokens.end))?;
            return quotient.is_finite().then_some(quotient);
        }
        if let Some(number) = number_of(file, tokens) {
            return Some(number);
        }
        let (datum, stated) = self.datum(routine, tokens).ok()?;
        number_of(&self.files[datum.file], &stated.value)
    }
}
