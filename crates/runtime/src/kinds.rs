//! Enumerations whose kinds have words.

/// Defines an enumeration from its kinds with their words, with `ALL` kinds, the function of a kind's word, the kind that is
/// `named` by a word, and the `index` of a kind.
///
/// ```
/// vibrissa_runtime::kinds! {
///     /// A side.
///     #[derive(Debug, Clone, Copy, PartialEq)]
///     pub enum Side,
///     /// The word of the side.
///     fn word {
///         /// To the left.
///         Left = "left",
///         /// To the right.
///         Right = "right",
///     }
/// }
/// assert_eq!(Side::named("right"), Some(Side::Right));
/// assert_eq!(Side::ALL.map(Side::word), ["left", "right"]);
/// ```
#[macro_export]
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
            $vis const ALL: [Self; [$($word),*].len()] = [$(Self::$Kind),*];

            $(#[$about])*
            #[must_use]
            $vis const fn $word_of(self) -> &'static str {
                match self {
                    $(Self::$Kind => $word,)*
                }
            }

            /// The kind with this word.
            #[must_use]
            $vis fn named(word: &str) -> Option<Self> {
                Self::ALL.into_iter().find(|kind| kind.$word_of() == word)
            }

            /// The number of the kind, from 0.
            #[must_use]
            $vis const fn index(self) -> usize {
                self as usize
            }
        }
    };
}
