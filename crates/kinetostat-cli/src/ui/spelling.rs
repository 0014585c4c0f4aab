//! Suggestions for a misspelt word.

/// Longer words are no typing mistakes; the comparison costs the product of the lengths. Characters.
const LONGEST: usize = 60;

/// The known word nearest to a misspelled one.
pub(crate) fn nearest<'k>(given: &str, known: &[&'k str]) -> Option<&'k str> {
    if given.chars().nth(LONGEST).is_some() {
        return None;
    }
    known
        .iter()
        .map(|k| (strsim::damerau_levenshtein(given, k), *k))
        .filter(|(distance, k)| {
            *distance <= (k.chars().count().max(given.chars().count()) / 3).max(1)
        })
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, k)| k)
}
