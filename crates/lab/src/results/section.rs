//! Figures of a run as keys of its document.

use serde::ser::SerializeMap;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::Value;

use crate::score::Score;
use vibrissa_declare::figures::{Figure, Group, Kind, Metric};

/// The first metric of each section, and the key of the object that has the section, if it is not the document itself. A section
/// ends where the next one begins. Between sections, the document has keys that are no figures.
const SECTIONS: [(Metric, &str); 11] = [
    (Metric::SimulatedTime, ""),
    (Metric::ErrorMean, ""),
    (Metric::AlongMean, ""),
    (Metric::OutOfReach, ""),
    (Metric::Retrievals, ""),
    (Metric::Path, ""),
    (Metric::Collisions, "collisions."),
    (Metric::OutOfPlaneMax, "out_of_plane."),
    (Metric::InclinationMax, "inclination."),
    (Metric::InclinationBeyond, "inclination."),
    (Metric::TickMean, ""),
];

/// Figures that are neighbours in the document of a run, in the units of their keys. `S` is the index of the section.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Section<const S: usize>(Vec<Keyed>);

/// A figure with its key and its value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Keyed {
    pub(super) metric: Metric,
    pub(super) key: &'static str,
    pub(super) value: Option<f64>,
}

impl Keyed {
    fn figure(&self) -> &'static Figure {
        self.metric.figure()
    }
}

impl<const S: usize> Section<S> {
    /// The key of the object that has the section, with a dot. Empty for the document itself.
    pub(super) const OWNER: &'static str = SECTIONS[S].1;

    /// The section of a run with these values (SI).
    fn new(value: impl Fn(Metric) -> Option<f64>) -> Self {
        Self::keyed(|metric, _| value(metric).map(|value| value * metric.figure().units()))
    }

    /// The section of a run with these values in the units of their keys.
    fn keyed(value: impl Fn(Metric, &'static str) -> Option<f64>) -> Self {
        let first = SECTIONS[S].0;
        let next = SECTIONS.get(S + 1).map(|(next, _)| *next);
        let metrics =
            Metric::ALL.into_iter().filter(|metric| *metric >= first && next.is_none_or(|next| *metric < next));
        let keyed = |metric: Metric| {
            let key = metric.figure().key?;
            Some(Keyed { metric, key, value: value(metric, key) })
        };
        Self(metrics.filter_map(keyed).collect())
    }

    /// The section of a run with this score.
    pub(super) fn of(score: &Score) -> Self {
        Self::new(|metric| score.figure(metric))
    }

    /// The section of a run that could not begin. Figures that every run has are zero.
    pub(super) fn empty() -> Self {
        let is_zero = |metric: Metric| {
            let figure = metric.figure();
            let groups = figure.key.unwrap_or_default().match_indices('.').map(|(dot, _)| dot);
            let is_in_null =
                |dot| Group::of(&figure.key.unwrap_or_default()[..dot]).is_some_and(|group| group.may_be_null);
            figure.is_always_known && !groups.into_iter().any(is_in_null)
        };
        Self::new(|metric| is_zero(metric).then_some(0.0))
    }

    /// The figures.
    pub(super) fn figures(&self) -> &[Keyed] {
        &self.0
    }
}

/// The parts of keyed figures below a key of `depth` bytes: the key of each part, and its figures.
pub(super) fn parts(figures: &[Keyed], depth: usize) -> impl Iterator<Item = (&'static str, &[Keyed])> {
    let end = move |key: &'static str| key[depth..].find('.').map_or(key.len(), |dot| depth + dot);
    let part = move |figure: &Keyed| &figure.key[..end(figure.key)];
    figures.chunk_by(move |one, next| part(one) == part(next)).map(move |chunk| (part(&chunk[0]), chunk))
}

/// The keys below a key of `depth` bytes.
struct Below<'s> {
    figures: &'s [Keyed],
    depth: usize,
}

impl Serialize for Below<'_> {
    fn serialize<T: Serializer>(&self, serializer: T) -> Result<T::Ok, T::Error> {
        let mut map = serializer.serialize_map(None)?;
        for (key, figures) in parts(self.figures, self.depth) {
            let name = &key[self.depth..];
            match figures {
                [figure] if figure.key == key => match (figure.value, figure.figure().kind) {
                    #[expect(
                        clippy::cast_possible_truncation,
                        clippy::cast_sign_loss,
                        reason = "a count is a whole number"
                    )]
                    (Some(count), Kind::Count) => map.serialize_entry(name, &(count as u64))?,
                    (Some(truth), Kind::Truth) => map.serialize_entry(name, &(truth > 0.5))?,
                    (value, _) => map.serialize_entry(name, &value)?,
                },
                _ if Group::of(key).is_some_and(|group| group.may_be_null)
                    && figures.iter().all(|figure| figure.value.is_none()) =>
                {
                    map.serialize_entry(name, &())?;
                }
                _ => map.serialize_entry(name, &Self { figures, depth: key.len() + 1 })?,
            }
        }
        map.end()
    }
}

impl<const S: usize> Serialize for Section<S> {
    fn serialize<T: Serializer>(&self, serializer: T) -> Result<T::Ok, T::Error> {
        Below { figures: &self.0, depth: Self::OWNER.len() }.serialize(serializer)
    }
}

impl<'de, const S: usize> Deserialize<'de> for Section<S> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let document = Value::deserialize(deserializer)?;
        Ok(Self::keyed(|_, key| number_at(&document, &key[Self::OWNER.len()..])))
    }
}

/// The value of a figure in the JSON document of a run, in the unit of its key. `None` if the run does not have it.
#[must_use]
pub fn figure_in(document: &Value, metric: Metric) -> Option<f64> {
    number_at(document, metric.figure().key?)
}

/// The number at a key with dots, a truth as 1 or 0.
fn number_at(document: &Value, key: &str) -> Option<f64> {
    let value = key.split('.').try_fold(document, |value, key| value.get(key))?;
    value.as_f64().or_else(|| value.as_bool().map(|truth| f64::from(u8::from(truth))))
}

#[cfg(feature = "schema")]
mod schema {
    use std::borrow::Cow;

    use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
    use serde_json::{Map, Value, json};

    use super::{Group, Keyed, Kind, Section, parts};

    impl<const S: usize> JsonSchema for Section<S> {
        fn inline_schema() -> bool {
            true
        }

        fn schema_name() -> Cow<'static, str> {
            format!("Section{S}").into()
        }

        fn json_schema(_: &mut SchemaGenerator) -> Schema {
            let (properties, required) = below(&Self::empty().0, Self::OWNER.len());
            json_schema!({ "type": "object", "properties": properties, "required": required })
        }
    }

    /// The properties below a key of `depth` bytes, and their names in order.
    fn below(figures: &[Keyed], depth: usize) -> (Map<String, Value>, Vec<&'static str>) {
        let properties = parts(figures, depth).map(|(key, figures)| {
            let schema = match figures {
                [figure] if figure.key == key => of_figure(figure),
                _ => of_group(key, figures),
            };
            (&key[depth..], schema)
        });
        let properties: Vec<_> = properties.collect();
        let required = properties.iter().map(|(name, _)| *name).collect();
        (properties.into_iter().map(|(name, schema)| (name.to_owned(), schema)).collect(), required)
    }

    fn of_group(key: &'static str, figures: &[Keyed]) -> Value {
        let (properties, required) = below(figures, key.len() + 1);
        let group = Group::of(key);
        let r#type =
            if group.is_some_and(|group| group.may_be_null) { json!(["object", "null"]) } else { json!("object") };
        json!({
            "description": group.map(Group::sentence), "type": r#type, "properties": properties, "required": required,
        })
    }

    fn of_figure(keyed: &Keyed) -> Value {
        let figure = keyed.figure();
        let (r#type, format) = match figure.kind {
            Kind::Count => ("integer", Some("uint")),
            Kind::Truth => ("boolean", None),
            _ => ("number", Some("double")),
        };
        let r#type = if figure.is_always_known { json!(r#type) } else { json!([r#type, "null"]) };
        let mut schema =
            Map::from_iter([("description".to_owned(), json!(figure.sentence())), ("type".to_owned(), r#type)]);
        schema.extend(format.map(|format| ("format".to_owned(), json!(format))));
        schema.extend((figure.kind == Kind::Count).then(|| ("minimum".to_owned(), json!(0))));
        Value::Object(schema)
    }
}
