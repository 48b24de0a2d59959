/// A position in which a word is allowed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Position {
    /// At the beginning of a file.
    File,
    /// Outside of all braces.
    Item,
    /// Outside of all braces in a library.
    Library,
    /// In the braces of a state.
    State,
    /// In the braces of a test or a property.
    Test,
    /// In any braces.
    Statement,
    /// Within a statement.
    Inside,
    /// At a value.
    Value,
    /// At a value in a test.
    Run,
    /// At the name of a state.
    Target,
    /// After `mark`.
    Mark,
    /// After `needs`.
    Need,
    /// After `by`.
    TipModel,
    /// After the title of a property.
    Property,
    /// After the `=` of a type.
    Type,
}
