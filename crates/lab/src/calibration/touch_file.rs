//! Files of touches of a known object as comma-separated values.

use csv::{ReaderBuilder, StringRecord, Trim, Writer};
use serde::{Deserialize, Serialize};
use vibrissa_runtime::calibration::TouchReading;
use vibrissa_runtime::mechanics::Obstacle;

use super::columns::check_columns;
use super::contact_sets::SetsError;
use super::next_touch::MissedTouch;
use super::touch_procedure::Pin;
use vibrissa_world::geometry::{Point2, Pose};

/// Largest number of touches in a file.
const MOST: usize = 1000;
/// Largest magnitudes of a length (mm), an angle (degrees) and a base angle (µrad).
const FAR: f64 = 1e5;
const TURNS: f64 = 3600.0;
const BENT: f64 = 1e6;

/// The columns of a file: the required ones, and the optional ones.
const NEEDED: [&str; 11] = [
    "whisker",
    "body_x_mm",
    "body_y_mm",
    "heading_deg",
    "object",
    "object_x_mm",
    "object_y_mm",
    "side",
    "base_angle_urad",
    "in_air_urad",
    "deviation_urad",
];
const OPTIONAL: [&str; 2] = ["radius_mm", "normal_deg"];

/// A touch as a line of a file.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Row {
    whisker: String,
    body_x_mm: f64,
    body_y_mm: f64,
    heading_deg: f64,
    object: Object,
    object_x_mm: f64,
    object_y_mm: f64,
    radius_mm: Option<f64>,
    normal_deg: Option<f64>,
    side: Side,
    /// No value for a touch in which the whisker met nothing. The two others then have none either.
    base_angle_urad: Option<f64>,
    in_air_urad: Option<f64>,
    deviation_urad: Option<f64>,
}

/// The touches in a file, each with the name of its whisker.
#[derive(Debug, Clone, Default)]
pub struct TouchFile {
    /// Touches with their readings, in the order of time.
    pub touches: Vec<(String, TouchReading)>,
    /// Touches of a pin in which the whisker met nothing.
    pub missed: Vec<(String, MissedTouch)>,
}

/// The touch of a line.
enum Touch {
    Read(TouchReading),
    Missed(MissedTouch),
}

/// The touched part of the object.
#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Object {
    Pin,
    Edge,
    Face,
    UnknownFace,
}

/// The side to which the object bends the whisker.
#[derive(Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Side {
    Left,
    Right,
}

/// Reads touches with their readings from comma-separated values, each with the name of its whisker. Lines that begin with `#` are
/// ignored.
///
/// # Errors
/// [`SetsError`] with the first invalid line, or if there are no touches.
pub fn read_touches(bytes: &[u8]) -> Result<Vec<(String, TouchReading)>, SetsError> {
    let touches = read_touch_file(bytes)?.touches;
    if touches.is_empty() {
        return Err(SetsError::new(1, "there are no touches; write one in each line below the header".to_owned()));
    }
    Ok(touches)
}

/// Reads touches as [`read_touches`] does, with those in which the whisker met nothing. There may be none.
///
/// # Errors
/// [`SetsError`] with the first invalid line.
pub fn read_touch_file(bytes: &[u8]) -> Result<TouchFile, SetsError> {
    let mut reader = ReaderBuilder::new().trim(Trim::All).comment(Some(b'#')).from_reader(bytes);
    let refusal = |error: csv::Error| {
        let line = error.position().map_or(1, csv::Position::line);
        SetsError::new(line, "every line must be UTF-8 text with as many values as the header has names".to_owned())
    };
    let header = reader.headers().map_err(refusal)?.clone();
    check_columns(&header, &NEEDED, &OPTIONAL, |_| "").map_err(|reason| SetsError::new(1, reason))?;
    let mut file = TouchFile::default();
    for record in reader.records() {
        let record = record.map_err(refusal)?;
        let line = record.position().map_or(0, csv::Position::line);
        if file.touches.len() + file.missed.len() == MOST {
            return Err(SetsError::new(line, format!("there are more than {MOST} touches")));
        }
        let row = record.deserialize(Some(&header)).map_err(|error| cause(&error, &header, &record));
        match row.and_then(Row::touch).map_err(|reason| SetsError::new(line, reason))? {
            (whisker, Touch::Read(touch)) => file.touches.push((whisker, touch)),
            (whisker, Touch::Missed(touch)) => file.missed.push((whisker, touch)),
        }
    }
    Ok(file)
}

/// The touches of whiskers as text that [`read_touches`] reads.
///
/// # Errors
/// [`csv::Error`] if a value cannot be written.
pub fn write_touches<'t>(touches: impl Iterator<Item = (&'t str, &'t TouchReading)>) -> Result<String, csv::Error> {
    write_rows(touches.map(|(whisker, touch)| Row::of(whisker, touch)))
}

/// A file of touches as text that [`read_touch_file`] reads.
///
/// # Errors
/// [`csv::Error`] if a value cannot be written.
pub fn write_touch_file(file: &TouchFile) -> Result<String, csv::Error> {
    let missed = file.missed.iter().map(|(whisker, touch)| Row::of_missed(whisker, touch));
    write_rows(file.touches.iter().map(|(whisker, touch)| Row::of(whisker, touch)).chain(missed))
}

fn write_rows(rows: impl Iterator<Item = Row>) -> Result<String, csv::Error> {
    let mut writer = Writer::from_writer(Vec::new());
    for row in rows {
        writer.serialize(row)?;
    }
    let bytes = writer.into_inner().map_err(|error| csv::Error::from(error.into_error()))?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// The columns of words, with the possible ones.
const WORDS: [(&str, &[&str]); 2] =
    [("object", &["pin", "edge", "face", "unknown_face"]), ("side", &["left", "right"])];

/// What is wrong with the value of a line.
fn cause(error: &csv::Error, header: &StringRecord, record: &StringRecord) -> String {
    // The reader tells the column of a number, and not that of a word.
    let column = match error.kind() {
        csv::ErrorKind::Deserialize { err, .. } => err.field().and_then(|field| usize::try_from(field).ok()),
        _ => None,
    };
    if let Some((name, found)) = column.and_then(|column| header.get(column).zip(record.get(column))) {
        return format!("`{name}` must be a number, and is `{found}`");
    }
    let mut values = header.iter().zip(record);
    let wrong = values.find_map(|(name, found)| {
        let (_, words) = WORDS.into_iter().find(|(column, words)| *column == name && !words.contains(&found))?;
        Some(format!("`{name}` must be one of `{}`, and is `{found}`", words.join("`, `")))
    });
    wrong.unwrap_or_else(|| "the values cannot be read".to_owned())
}

impl Row {
    fn of(whisker: &str, touch: &TouchReading) -> Self {
        let (object, point, radius, normal) = match touch.obstacle {
            Obstacle::Pin { centre, radius: 0.0 } => (Object::Edge, centre, None, None),
            Obstacle::Pin { centre, radius } => (Object::Pin, centre, Some(radius), None),
            Obstacle::Face { point, normal } if touch.is_known => (Object::Face, point, None, Some(normal)),
            Obstacle::Face { point, normal } => (Object::UnknownFace, point, None, Some(normal)),
        };
        Self {
            whisker: whisker.to_owned(),
            body_x_mm: 1e3 * touch.body.position.x,
            body_y_mm: 1e3 * touch.body.position.y,
            heading_deg: touch.body.heading.to_degrees(),
            object,
            object_x_mm: 1e3 * point.x,
            object_y_mm: 1e3 * point.y,
            radius_mm: radius.map(|radius| 1e3 * radius),
            normal_deg: normal.map(f64::to_degrees),
            side: if touch.side > 0.0 { Side::Left } else { Side::Right },
            base_angle_urad: Some(1e6 * touch.base_angle),
            in_air_urad: Some(1e6 * touch.in_air),
            deviation_urad: Some(1e6 * touch.deviation),
        }
    }

    fn of_missed(whisker: &str, touch: &MissedTouch) -> Self {
        let obstacle = Obstacle::Pin { centre: touch.pin.centre, radius: touch.pin.radius };
        let nothing = [0.0; 3];
        let [base_angle, in_air, deviation] = nothing;
        let (body, side) = (touch.body, touch.side);
        let read = TouchReading { body, obstacle, is_known: true, side, base_angle, in_air, deviation };
        Self { base_angle_urad: None, in_air_urad: None, deviation_urad: None, ..Self::of(whisker, &read) }
    }

    /// The touch of the line, with the name of its whisker.
    fn touch(self) -> Result<(String, Touch), String> {
        let within = |name: &str, value: f64, most: f64| {
            if value.abs() <= most { Ok(value) } else { Err(format!("`{name}` must be from -{most} to {most}")) }
        };
        let millimetres = |name, value| within(name, value, FAR).map(|value| 1e-3 * value);
        let degrees = |name, value| within(name, value, TURNS).map(f64::to_radians);
        let microradians = |name, value| within(name, value, BENT).map(|value| 1e-6 * value);
        let point =
            Point2::new(millimetres("object_x_mm", self.object_x_mm)?, millimetres("object_y_mm", self.object_y_mm)?);
        let obstacle = match (self.object, self.radius_mm, self.normal_deg) {
            (Object::Pin, Some(radius), None) if radius > 0.0 => {
                Obstacle::Pin { centre: point, radius: millimetres("radius_mm", radius)? }
            }
            (Object::Pin, ..) => return Err("a pin needs `radius_mm` above 0, and no `normal_deg`".to_owned()),
            (Object::Edge, None, None) => Obstacle::Pin { centre: point, radius: 0.0 },
            (Object::Edge, ..) => return Err("an edge has neither `radius_mm` nor `normal_deg`".to_owned()),
            (Object::Face | Object::UnknownFace, None, Some(normal)) => {
                Obstacle::Face { point, normal: degrees("normal_deg", normal)? }
            }
            (Object::Face | Object::UnknownFace, ..) => {
                return Err(
                    "a face needs `normal_deg`, its direction towards the whisker, and no `radius_mm`".to_owned()
                );
            }
        };
        let body = Pose {
            position: Point2::new(millimetres("body_x_mm", self.body_x_mm)?, millimetres("body_y_mm", self.body_y_mm)?),
            heading: degrees("heading_deg", self.heading_deg)?,
        };
        let side = if self.side == Side::Left { 1.0 } else { -1.0 };
        let touch = match (self.base_angle_urad, self.in_air_urad, self.deviation_urad, obstacle) {
            (None, None, None, Obstacle::Pin { centre, radius }) if radius > 0.0 => {
                Touch::Missed(MissedTouch { body, pin: Pin { centre, radius }, side })
            }
            (Some(base_angle), Some(in_air), Some(deviation), _) if deviation > 0.0 => Touch::Read(TouchReading {
                body,
                obstacle,
                is_known: !matches!(self.object, Object::UnknownFace),
                side,
                base_angle: microradians("base_angle_urad", base_angle)?,
                in_air: microradians("in_air_urad", in_air)?,
                deviation: microradians("deviation_urad", deviation)?,
            }),
            (Some(_), Some(_), Some(_), _) => {
                return Err(
                    "`deviation_urad` must be above 0: the standard deviation of the two mean readings".to_owned()
                );
            }
            _ => {
                return Err(
                    "`base_angle_urad`, `in_air_urad` and `deviation_urad` are needed; only a touch of a pin that met nothing has none of them"
                        .to_owned(),
                );
            }
        };
        Ok((self.whisker, touch))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may panic")]
    use super::*;
    use proptest::prelude::*;

    const HEADER: &str = "whisker,body_x_mm,body_y_mm,heading_deg,object,object_x_mm,object_y_mm,radius_mm,normal_deg,side,\
                          base_angle_urad,in_air_urad,deviation_urad\n";

    fn error(line: &str) -> String {
        read_touches(format!("# a comment\n{HEADER}{line}\n").as_bytes()).unwrap_err().to_string()
    }

    #[test]
    fn a_line_that_cannot_be_used_is_refused_with_its_number_and_reason() {
        assert!(error("r0,0,0,0,pin,1,2,,,left,1,1,0.1").starts_with("line 3: a pin needs `radius_mm`"));
        assert!(error("r0,0,0,0,face,1,2,,,left,1,1,0.1").contains("a face needs `normal_deg`"));
        assert!(error("r0,0,0,0,edge,1,2,3,,left,1,1,0.1").contains("an edge has neither"));
        assert!(error("r0,0,0,0,edge,1,2,,,left,1,1,0").contains("`deviation_urad` must be above 0"));
        assert!(error("r0,0,0,0,pin,1,2,3,,left,,1,0.1").contains("only a touch of a pin that met nothing"));
        assert!(error("r0,0,0,0,edge,1,2,,,left,,,").contains("only a touch of a pin that met nothing"));
        assert!(error("r0,0,0,0,pin,1,2,3,,left,,,").contains("there are no touches"));
        assert!(error("r0,nan,0,0,edge,1,2,,,left,1,1,0.1").contains("`body_x_mm` must be"));
        assert!(
            error("r0,0,0,0,edge,1,2,,,middle,1,1,0.1")
                .ends_with("`side` must be one of `left`, `right`, and is `middle`")
        );
        assert!(error("r0,0,0,0,wall,1,2,,,left,1,1,0.1").contains("`object` must be one of `pin`, `edge`, `face`"));
        assert!(error("r0,far,0,0,edge,1,2,,,left,1,1,0.1").ends_with("`body_x_mm` must be a number, and is `far`"));
        assert!(error("r0,0,0").contains("as many values"));
        let header = |text: &str| read_touches(text.as_bytes()).unwrap_err().to_string();
        let found = header(&HEADER.replace("heading_deg", "headng_deg"));
        assert!(found.starts_with("line 1: there is no column `headng_deg`; did you mean `heading_deg`?"), "{found}");
        assert!(header(&HEADER.replace(',', ";")).contains("separated by commas"));
        assert!(header(&HEADER.replace("side,", "")).contains("the column `side` is missing"));
        assert!(header(&HEADER.replace("radius_mm", "side")).contains("the column `side` occurs twice"));
        assert!(read_touches(HEADER.as_bytes()).unwrap_err().to_string().contains("there are no touches"));
    }

    proptest! {
        #[test]
        fn touches_that_are_written_are_read_again(
            position in [-2.0..2.0_f64, -2.0..2.0_f64],
            heading in -3.0..3.0_f64,
            size in 0.0..0.1_f64,
            kind in 0..4,
            is_left in any::<bool>(),
            readings in [-1e-3..1e-3_f64, -1e-5..1e-5_f64, 1e-9..1e-6_f64],
        ) {
            let point = Point2::new(size, position[0]);
            let obstacle = match kind {
                0 => Obstacle::Pin { centre: point, radius: size + 1e-4 },
                1 => Obstacle::Pin { centre: point, radius: 0.0 },
                _ => Obstacle::Face { point, normal: heading },
            };
            let touch = TouchReading {
                body: Pose { position: position.into(), heading },
                obstacle,
                is_known: kind != 3,
                side: if is_left { 1.0 } else { -1.0 },
                base_angle: readings[0],
                in_air: readings[1],
                deviation: readings[2],
            };
            let text = write_touches(std::iter::once(("r0", &touch))).unwrap();
            let [(whisker, found)] = read_touches(text.as_bytes()).unwrap().try_into().unwrap();
            prop_assert_eq!(whisker, "r0");
            prop_assert_eq!((found.side, found.is_known), (touch.side, touch.is_known));
            let near = |a: f64, b: f64| (a - b).abs() < 1e-12;
            prop_assert!((found.body.position - touch.body.position).norm() < 1e-12 && near(found.body.heading, heading));
            prop_assert!(near(found.base_angle, touch.base_angle) && near(found.in_air, touch.in_air));
            prop_assert!(near(found.deviation, touch.deviation));
            let same = match (found.obstacle, obstacle) {
                (Obstacle::Pin { centre: a, radius: r }, Obstacle::Pin { centre: b, radius: s }) => {
                    (a - b).norm() < 1e-12 && near(r, s) && (r == 0.0) == (s == 0.0)
                }
                (Obstacle::Face { point: a, normal: n }, Obstacle::Face { point: b, normal: m }) => {
                    (a - b).norm() < 1e-12 && near(n, m)
                }
                _ => false,
            };
            prop_assert!(same, "{:?}", found.obstacle);
        }

        #[test]
        fn touches_that_met_nothing_are_written_beside_the_others_and_read_again(
            position in [-2.0..2.0_f64, -2.0..2.0_f64],
            heading in -3.0..3.0_f64,
            radius in 1e-4..0.1_f64,
        ) {
            let (body, pin) = (Pose { position: position.into(), heading }, Pin { centre: Point2::new(0.1, heading), radius });
            let missed = MissedTouch { body, pin, side: -1.0 };
            let obstacle = Obstacle::Pin { centre: pin.centre, radius };
            let read = TouchReading { body, obstacle, is_known: true, side: 1.0, base_angle: 1e-4, in_air: 0.0, deviation: 1e-7 };
            let name = "l0".to_owned();
            let file = TouchFile { touches: vec![(name.clone(), read)], missed: vec![(name, missed); 2] };
            let text = write_touch_file(&file).unwrap();
            let found = read_touch_file(text.as_bytes()).unwrap();
            prop_assert_eq!((found.touches.len(), found.missed.len()), (1, 2));
            prop_assert_eq!(read_touches(text.as_bytes()).unwrap().len(), 1);
            let (whisker, again) = &found.missed[1];
            prop_assert_eq!((whisker.as_str(), again.side), ("l0", -1.0));
            prop_assert!((again.body.position - body.position).norm() < 1e-12 && (again.body.heading - heading).abs() < 1e-12);
            prop_assert!((again.pin.centre - pin.centre).norm() < 1e-12 && (again.pin.radius - radius).abs() < 1e-12);
        }
    }
}
