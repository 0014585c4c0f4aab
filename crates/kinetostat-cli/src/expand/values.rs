//! Options of the form NUMBER=VALUE.

use std::collections::BTreeMap;

use crate::ui::failure::{Answer, Failure};

/// The values by their numbers.
pub(super) fn numbered(option: &str, words: &[String]) -> Answer<BTreeMap<u32, f64>> {
    let mut values = BTreeMap::new();
    for word in words {
        let refuse = |what: &str| {
            Failure::input(format!(
                "{option} '{word}': {what}; write a number and its value, as in 3=6.5"
            ))
        };
        let (number, value) = word
            .split_once('=')
            .ok_or_else(|| refuse("there is no ="))?;
        let number: u32 = number
            .trim()
            .parse()
            .map_err(|_| refuse("before the = stands no whole number"))?;
        let value = value.trim().parse().ok().filter(|x: &f64| x.is_finite());
        let value = value.ok_or_else(|| refuse("behind the = stands no number"))?;
        if values.insert(number, value).is_some() {
            return Err(refuse("the number comes twice"));
        }
    }
    Ok(values)
}
