//! Words of scene files: an enumeration whose variants are written as words.

/// An enumeration with the word of each variant, and the list of them.
macro_rules! words {
    ($(#[$doc:meta])* $visibility:vis enum $name:ident { $($(#[$about:meta])* $variant:ident = $word:literal,)* }) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
        $visibility enum $name {
            $($(#[$about])* #[serde(rename = $word)] $variant,)*
        }

        impl $name {
            /// The words, in the order of the variants.
            pub(crate) const WORDS: &[&str] = &[$($word),*];
        }
    };
}
pub(crate) use words;
