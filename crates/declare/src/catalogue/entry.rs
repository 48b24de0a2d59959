//! Families of scenes by name.

use super::Parameter;

/// The name of a family of scenes and its parameters.
#[derive(Debug, PartialEq)]
pub struct Entry {
    /// The name: letters and `-`.
    pub name: &'static str,
    /// Description of its scenes.
    pub about: &'static str,
    /// All parameters. Together they determine a scene.
    pub parameters: &'static [Parameter],
}

impl Entry {
    /// The parameter with this name.
    #[must_use]
    pub fn parameter(&self, name: &str) -> Option<&'static Parameter> {
        self.parameters.iter().find(|parameter| parameter.name == name)
    }
}
