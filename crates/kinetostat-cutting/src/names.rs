//! Names that people spell in many ways.

/// A name without what does not matter: case, spaces, hyphens, dots and other signs.
pub(crate) fn bare(name: &str) -> String {
    name.chars()
        .filter(|sign| sign.is_alphanumeric())
        .flat_map(char::to_lowercase)
        .collect()
}

/// The closest of some names, best first, at most `most`; only those that could be a typing mistake.
pub(crate) fn nearest<'n>(
    given: &str,
    known: impl IntoIterator<Item = &'n str>,
    most: usize,
) -> Vec<&'n str> {
    let wanted = bare(given);
    let length = wanted.chars().count();
    // Long names cannot be typing mistakes, and the comparison costs the product of the lengths.
    if length > 60 {
        return Vec::new();
    }
    let mut found: Vec<(usize, &str)> = known
        .into_iter()
        .filter_map(|name| {
            let other = bare(name);
            let longest = other.chars().count().max(length);
            let distance = strsim::damerau_levenshtein(&wanted, &other);
            (distance <= (longest / 3).max(1) && distance < longest).then_some((distance, name))
        })
        .collect();
    found.sort_by_key(|(distance, _)| *distance);
    found.truncate(most);
    found.into_iter().map(|(_, name)| name).collect()
}
