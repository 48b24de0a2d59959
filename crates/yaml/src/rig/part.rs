//! Reader of the keys of one part of a rig.

use vibrissa_declare::rig::{KEYS, Part, group};

use super::{Places, Use};
use crate::fields::Fields;
use crate::node::Entry;
use crate::reader::Reader;

/// The reading of a rig.
pub(super) struct Reading {
    pub(super) rig_use: Use,
    pub(super) places: Places,
}

impl Reading {
    /// Reads the mapping of `entry`, whose keys begin with `path`, into a part.
    pub(super) fn section<T: Part>(
        &mut self,
        reader: &mut Reader<'_>,
        entry: &Entry,
        path: &'static str,
        part: &mut T,
    ) {
        let Some(mut fields) = Fields::of(reader, &entry.value, group(path), entry.key.span) else { return };
        self.keys(reader, &mut fields, path, &[], part);
        fields.finish(reader);
    }

    /// Reads all keys below `path`. Those in `needed` must be there.
    pub(super) fn keys<T: Part>(
        &mut self,
        reader: &mut Reader<'_>,
        fields: &mut Fields<'_>,
        path: &'static str,
        needed: &[&str],
        part: &mut T,
    ) {
        let mut groups = Vec::new();
        for key in KEYS {
            let Some(access) = T::access(key.place) else { continue };
            let Some(name) = key.path.strip_prefix(path).and_then(|rest| rest.strip_prefix('.')) else { continue };
            if let Some((inner, _)) = name.split_once('.') {
                if !groups.contains(&inner) {
                    groups.push(inner);
                    let path = key.path.get(..path.len() + 1 + inner.len()).unwrap_or_default();
                    if let Some(entry) = fields.entry(inner) {
                        self.section(reader, entry, path, part);
                    }
                }
                continue;
            }
            let entry = if needed.contains(&name) { fields.required(name, key.example) } else { fields.entry(name) };
            let Some(entry) = entry else { continue };
            let read = if (self.rig_use.applies)(key) {
                super::value::read(reader, entry, key, access, part)
            } else {
                super::value::read(reader, entry, key, access, &mut part.clone())
            };
            self.places.values.extend(read.map(|span| (key.path, span)));
        }
    }
}
