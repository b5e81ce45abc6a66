//! Words of scene files: an enumeration whose variants are written as words.

/// An enumeration with the word of each variant, and the list of them.
macro_rules! words {
    ($(#[$doc:meta])* $visibility:vis enum $name:ident { $($(#[$about:meta])* $variant:ident = $word:literal,)* }) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
        $visibility enum $name {
            $($(#[$about])* #[serde(rename = $word)] $variant,)*
        }

        impl $name {
            /// The words, in the order of the variants.
            pub(crate) const WORDS: &[&str] = &[$($word),*];

            /// The variants, in the same order.
            #[allow(dead_code, reason = "not every enumeration is looked up by its words")]
            pub(crate) const ALL: &[Self] = &[$(Self::$variant),*];
        }
    };
}
pub(crate) use words;
