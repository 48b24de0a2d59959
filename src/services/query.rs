//! Queries of the dashboard, in InfluxQL.

/// A query of the database. `$robot`, `$timeFilter` and `$__interval` are variables of Grafana.
#[derive(Debug, Clone)]
pub(super) struct Query {
    pub(super) text: String,
    pub(super) is_table: bool,
    /// The name of its series. It may have variables such as `$tag_whisker`.
    pub(super) alias: String,
}

/// The points of the robot within the shown time.
const WHERE: &str = "WHERE \"robot\" = '$robot' AND $timeFilter";

impl Query {
    /// A function of a field in intervals of the screen, for each value of a tag.
    pub(super) fn series(function: &str, field: &str, measurement: &str, tag: Option<&str>, alias: &str) -> Self {
        let group = tag.map_or_else(String::new, |tag| format!(", \"{tag}\""));
        let text = format!(
            "SELECT {function}(\"{field}\") FROM \"{measurement}\" {WHERE} GROUP BY time($__interval){group} fill(none)"
        );
        Self { text, is_table: false, alias: alias.to_owned() }
    }

    /// Every point of a field.
    pub(super) fn points(field: &str, measurement: &str, alias: &str) -> Self {
        Self {
            text: format!("SELECT \"{field}\" FROM \"{measurement}\" {WHERE}"),
            is_table: false,
            alias: alias.to_owned(),
        }
    }

    /// The last value of a field at any time, for each service.
    pub(super) fn last(field: &str, measurement: &str, alias: &str) -> Self {
        let text =
            format!("SELECT last(\"{field}\") FROM \"{measurement}\" WHERE \"robot\" = '$robot' GROUP BY \"service\"");
        Self { text, is_table: false, alias: alias.to_owned() }
    }

    /// A table of columns, which are written as in InfluxQL. `rest` follows the condition.
    pub(super) fn table(columns: &str, measurement: &str, rest: &str) -> Self {
        let text = format!("SELECT {columns} FROM \"{measurement}\" {WHERE} {rest}");
        Self { text, is_table: true, alias: String::new() }
    }
}
