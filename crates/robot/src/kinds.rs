//! Enumerations whose kinds have words.

/// Defines an enumeration from its kinds with their words, with `ALL` kinds, the `index` of a kind and the function of its
/// word.
macro_rules! kinds {
    ($(#[$meta:meta])* $vis:vis enum $Name:ident, $(#[$about:meta])* fn $word_of:ident {
        $($(#[$doc:meta])* $Kind:ident = $word:literal,)*
    }) => {
        $(#[$meta])*
        $vis enum $Name {
            $($(#[$doc])* $Kind,)*
        }

        impl $Name {
            /// All kinds.
            pub const ALL: [Self; [$($word),*].len()] = [$(Self::$Kind),*];

            $(#[$about])*
            #[must_use]
            pub fn $word_of(self) -> &'static str {
                match self {
                    $(Self::$Kind => $word,)*
                }
            }

            /// The number of the kind, from 0.
            #[must_use]
            pub fn index(self) -> usize {
                self as usize
            }
        }
    };
}
pub(crate) use kinds;
