//! What was probably meant: a name that is misspelt, has another unit, or is another word for the same.

use crate::scene::keys::{Key, Kind, joined};
use crate::scene::tables::KEYS;

/// The key that a word comes close to, of the table that it was found in or else of another, as a question.
pub(crate) fn key(found: &str, here: &'static [Key]) -> Option<String> {
    let word = found.to_lowercase();
    if OF_CURRENTS.iter().any(|start| word.starts_with(start)) {
        return Some(BY_CURRENT.to_owned());
    }
    let asks = |key: &Key, name: String| match key.unit {
        "" | "1" => format!("did you mean `{name}`?"),
        // The name says it where it is the word's beginning.
        _ if key.stem() == word => format!("did you mean `{name}`?"),
        unit => format!("did you mean `{name}`, in {unit}?"),
    };
    let elsewhere = || {
        let (path, key) = foreign(&word, KEYS, "")?;
        let heading = match key.kind {
            Kind::Table(_) | Kind::Parameters => return Some(format!("did you mean [{path}]?")),
            Kind::Tables(_) => return Some(format!("did you mean [[{path}]]?")),
            _ => path,
        };
        Some(asks(key, heading))
    };
    (here.iter().filter(|key| means(key, &word)))
        .max_by_key(|key| key.stem().len())
        .map(|key| asks(key, key.name.to_owned()))
        .or_else(|| self::word(found, here.iter().map(|key| key.name)))
        .or_else(elsewhere)
}

/// How magnets are given in newtons per ampere and amperes, and what to do with that.
const OF_CURRENTS: &[&str] = &["ki_", "k_i", "ks_", "k_s", "current", "i_max", "imax"];
const BY_CURRENT: &str = "magnets are told by force: force_max_n is k_i times the largest current, negative_stiffness_n_m is k_s; \
                          or give [magnet.poles] with currents and air gap";

/// The first key below a table that means this, with its path.
fn foreign(word: &str, keys: &'static [Key], path: &str) -> Option<(String, &'static Key)> {
    let here = keys.iter().find(|key| means(key, word));
    let here = here.map(|key| (joined(path, key.name), key));
    here.or_else(|| {
        (keys.iter()).find_map(|key| foreign(word, key.below(), &joined(path, key.name)))
    })
}

/// Whether a word is the key's name, or another word for it, with any unit behind or none.
fn means(key: &Key, word: &str) -> bool {
    let begins = |with: &str| {
        (word.strip_prefix(with)).is_some_and(|rest| match rest.strip_prefix('_') {
            Some(unit) => UNITS.contains(&unit),
            None => rest.is_empty(),
        })
    };
    begins(key.stem()) || key.aka.iter().any(|aka| begins(aka))
}

/// Units that people put behind names, those of scenes and others.
const UNITS: &[&str] = &[
    "m", "mm", "um", "mum", "kg", "g", "t", "s", "ms", "us", "hz", "khz", "rpm", "rad_s", "rads",
    "rad", "deg", "n", "kn", "n_m", "n_mm", "n_um", "kn_m", "kn_mm", "mn_m", "n_s_m", "ns_m",
    "kn_s_m", "m_s", "mm_s", "m_s2", "mm_s2", "kg_m2", "g_mm2", "nm", "n_s", "n_m_s", "samples",
    "percent", "pct",
];

/// The known word that a misspelt one comes close to, as a question.
pub(crate) fn word<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Option<String> {
    let limit = word.chars().count().div_ceil(3);
    // A key without its unit is the commonest mistake.
    let distance = |name: &str| match name.strip_prefix(word) {
        Some(unit) if unit.starts_with('_') => 1,
        _ => strsim::damerau_levenshtein(word, name),
    };
    let (distance, name) = (known.into_iter())
        .map(|name| (distance(name), name))
        .min_by_key(|(distance, _)| *distance)?;
    (distance <= limit).then(|| format!("did you mean `{name}`?"))
}

/// Advice with a guess before it, where there is one.
pub(crate) fn before<'a>(
    help: String,
    found: &str,
    known: impl IntoIterator<Item = &'a str>,
) -> String {
    word(found, known).map_or(help.clone(), |guess| format!("{guess} {help}"))
}
