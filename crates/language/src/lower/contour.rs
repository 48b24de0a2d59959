//! Contours: keypoints, and contours of positions.

use crate::ast::{self, File};
use crate::types::{Type, Value};
use crate::unit::{units_of, written};
use vibrissa_runtime::machine::{CONTOUR_LIMIT, Keypoints, PositionContour};
use vibrissa_runtime::units::Dimension;
use vibrissa_text::diagnostic::Diagnostic;

use super::Compiler;

impl<'f> Compiler<'f> {
    /// Declares the contours of positions. Their indices follow those of the whiskers.
    pub(super) fn declare_contours(&mut self, file: &'f File) {
        if let Some(extra) = file.contours.get(CONTOUR_LIMIT) {
            let message = format!("a policy can have {CONTOUR_LIMIT} contours of positions at most");
            let diagnostic = Diagnostic::error("P0403", message, extra.name.span, "one too many");
            self.report(diagnostic.hint("declare only the contours that the policy reads"));
        }
        for (index, contour) in (0..).zip(file.contours.iter().take(CONTOUR_LIMIT)) {
            let register = self.code.constant((file.whiskers.len() + usize::from(index)) as f64);
            let names = self.names_mut();
            names.globals.insert(&contour.name.text, Some(Value { r#type: Type::Contour, register }));
            names.contours.insert(&contour.name.text, index);
        }
    }

    /// The keypoints of the whiskers' contours, and the contours of positions.
    pub(super) fn contours(&mut self, file: &'f File) -> (Keypoints, Vec<PositionContour>) {
        if let [first, second, ..] = file.keypoints.as_slice() {
            let message = "the keypoints of the whiskers' contours are stated twice";
            let diagnostic = Diagnostic::error("P0415", message, second.span, "stated again");
            self.report(diagnostic.note(first.span, "stated here").hint("keep one of them"));
        }
        let of_whiskers = self.keypoints(file.keypoints.first());
        let contours = file.contours.iter().map(|contour| PositionContour {
            name: contour.name.text.clone(),
            keypoints: self.keypoints(contour.keypoints.as_ref()),
        });
        (of_whiskers, contours.collect())
    }

    /// Checks number and spacing of keypoints. The default is used instead of a faulty value.
    fn keypoints(&mut self, given: Option<&'f ast::Keypoints>) -> Keypoints {
        let mut keypoints = Keypoints::default();
        let Some(given) = given else { return keypoints };
        let (fewest, most) = (Keypoints::COUNT.start(), Keypoints::COUNT.end());
        match given.count.text.parse() {
            Ok(count) if Keypoints::COUNT.contains(&count) => keypoints.count = count,
            _ => {
                let message = format!("a contour has {fewest} to {most} points, not {}", given.count.text);
                let diagnostic = Diagnostic::error("P0306", message, given.count.span, "not such a number");
                self.report(diagnostic.hint(format!("write a whole number from {fewest} to {most}")));
            }
        }
        let Some((spacing, dimension)) = self.bound(&given.spacing, None) else { return keypoints };
        if dimension != Dimension::LENGTH {
            let message = "the distance between points is a length";
            let diagnostic =
                Diagnostic::error("P0301", message, given.spacing.span, format!("is {}", dimension.phrase()));
            self.report(diagnostic.hint(format!("write it in {}", units_of(Dimension::LENGTH).join(", "))));
        } else if Keypoints::SPACING.contains(&spacing) {
            keypoints.spacing = spacing;
        } else {
            let [low, high] = [*Keypoints::SPACING.start(), *Keypoints::SPACING.end()]
                .map(|length| written(length, Dimension::LENGTH));
            let message = format!("points are {low} to {high} apart");
            let label = format!("{} is outside of that", written(spacing, Dimension::LENGTH));
            let diagnostic = Diagnostic::error("P0306", message, given.spacing.span, label);
            self.report(diagnostic.hint(format!("write a distance from {low} to {high}")));
        }
        keypoints
    }
}
