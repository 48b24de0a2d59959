//! The figures of a run, each declared once.

use super::figure::{Cell, Figure, Kind};

use Cell::{Decimals, Positive, Spread};
use Kind::{Angle, Area, Count, Length, Ratio, Share, Time, Truth};

/// Declares the variants of [`Metric`] and their figures.
macro_rules! figures {
    ($($metric:ident: $figure:expr,)*) => {
        /// A figure of a run. Its [declaration](Metric::figure) has its meaning.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
        #[expect(missing_docs, reason = "the meaning of a figure is a part of its declaration")]
        pub enum Metric { $($metric,)* }

        /// The declarations of all figures, in the order of [`Metric::ALL`].
        pub static FIGURES: [Figure; Metric::ALL.len()] = [$($figure,)*];

        impl Metric {
            /// All metrics, in the order of the document of a run.
            pub const ALL: [Self; [$(stringify!($metric)),*].len()] = [$(Self::$metric,)*];
        }
    };
}

const fn figure(kind: Kind, key: &'static str, meaning: &'static str) -> Figure {
    Figure::new(kind, key, meaning)
}

/// The bounds of lengths, which are errors.
const ERROR: ((f64, f64), &str) = ((1e-9, 1.0), "0.8 mm");
const AREA: ((f64, f64), &str) = ((0.0, 1e4), "0.02 m^2");
const SHARE: ((f64, f64), &str) = ((0.0, 1.0), "95 %");
const COUNT: ((f64, f64), &str) = ((0.0, 1e6), "0");

figures! {
    SimulatedTime: figure(Time, "sim_s", "the simulated time").always().smaller().named("time").in_tests()
        .column(160, "sim s", Decimals(1)).compared(160, "sim_s"),

    ErrorMean: figure(Length, "error_mm.mean", "the mean distance of the recorded tips from the object")
        .smaller().named("error_mean").bound(ERROR.0, ERROR.1).in_tests()
        .column(30, "error mm", Spread).compared(10, "error_mm.mean"),
    ErrorStd: figure(Length, "error_mm.std", "the sample standard deviation"),
    ErrorP95: figure(Length, "error_mm.p95", "the 95th percentile of the distances of the recorded tips from the object")
        .smaller().named("error_p95").bound(ERROR.0, ERROR.1).in_tests()
        .column(180, "p95 error mm", Decimals(3)).compared(20, "error_mm.p95"),
    ErrorMax: figure(Length, "error_mm.max", "the maximum of the distances of the recorded tips from the object")
        .smaller().named("error_max").bound(ERROR.0, ERROR.1).in_tests()
        .column(40, "largest error mm", Decimals(3)).compared(30, "error_mm.max"),
    IntervalCoverage: figure(Share, "error_mm.within_band", "the share of recorded tips within the 95 % interval that they report, 0 to 1")
        .larger().named("interval_coverage").bound(SHARE.0, SHARE.1).column(170, "in 95 % interval", Decimals(1)),
    Outliers: figure(Share, "error_mm.outliers", "the share of recorded tips with an error above 0.1 mm plus four reported standard deviations, 0 to 1")
        .smaller().named("outliers").bound(SHARE.0, "0.2 %").in_tests().column(50, "outliers", Decimals(2)),
    Tips: figure(Count, "error_mm.n", "the number of recorded tips").always(),

    AlongMean: figure(Length, "tip_error_mm.along.mean", "the mean").always(),
    AlongP95: figure(Length, "tip_error_mm.along.p95", "the 95th percentile").always(),
    AlongMax: figure(Length, "tip_error_mm.along.max", "the maximum").always(),
    AcrossMean: figure(Length, "tip_error_mm.across.mean", "the mean").always(),
    AcrossP95: figure(Length, "tip_error_mm.across.p95", "the 95th percentile").always(),
    AcrossMax: figure(Length, "tip_error_mm.across.max", "the maximum").always(),
    Bias: figure(Length, "tip_error_mm.bias", "the mean magnitude of the mean error of each whisker perpendicular to the contour").always(),
    Scatter: figure(Length, "tip_error_mm.scatter", "the standard deviation of that error about the mean of its whisker. Unknown if no whisker has two tips"),

    Coverage: figure(Share, "coverage", "the share of the exact contour that was traced, 0 to 1").always()
        .larger().named("coverage").bound(SHARE.0, SHARE.1).in_tests()
        .column(60, "coverage", Decimals(1)).compared(40, "coverage"),
    ObjectCoverage: figure(Share, "object_coverage", "the share of the outline of the object whose loop closed that was traced, 0 to 1").always()
        .larger().named("object_coverage").bound(SHARE.0, SHARE.1),
    OutOfReach: figure(Share, "out_of_reach", "the share of the reference that was not traced and that the rig certainly cannot reach, 0 to 1").always(),
    CoverageInReach: figure(Share, "coverage_in_reach", "the share of the rest of the reference that was traced, 0 to 1").always()
        .larger().named("coverage_in_reach").bound(SHARE.0, SHARE.1),
    Passage: figure(Share, "passage.share", "the share of the tunnel's length that the platform's centre of mass covered between the walls, 0 to 1").always()
        .larger().named("passage").bound(SHARE.0, SHARE.1).column_if_known(70, "passage", Decimals(1)),
    LeftCoverage: figure(Share, "passage.left_coverage", "the share of the left inner side that was traced between the first and the last contact, 0 to 1").always(),
    RightCoverage: figure(Share, "passage.right_coverage", "the share of the right inner side").always(),
    ReachesBoth: figure(Truth, "passage.reaches_both", "true if the whiskers of the rig reach both walls at once").always(),
    WallCoverage: figure(Share, "passage.wall_coverage", "the lesser share of the two if the whiskers reach both walls at once, else the greater one").always()
        .larger().named("wall_coverage").bound(SHARE.0, SHARE.1).column_if_known(80, "wall coverage", Decimals(1)),
    Hausdorff: figure(Length, "hausdorff_mm", "the Hausdorff distance between the estimated and the exact contour")
        .smaller().named("hausdorff").bound(ERROR.0, ERROR.1).in_tests()
        .column(140, "farthest untraced mm", Decimals(3)).compared(50, "hausdorff_mm"),

    MapFreeArea: figure(Area, "map.free_m2", "the area that the map claims as free. Unknown without a map").always()
        .named("map_free_area").in_tests(),
    MapWrongFreeArea: figure(Area, "map.wrong_free_m2", "the part of that area that is more than 2 mm inside of an object. Unknown without a map").always()
        .smaller().named("map_wrong_free_area").bound(AREA.0, "0 m^2").in_tests().column_if_known(92, "wrongly free m\u{b2}", Decimals(6)),
    MapUnknownArea: figure(Area, "map.unknown_m2", "the area of the unknown ground beside free ground, which is left, also where the policy gave up. Unknown without a map").always()
        .smaller().named("map_unknown_area").bound(AREA.0, AREA.1).in_tests().column_if_known(94, "unknown m\u{b2}", Decimals(4)),

    Retrievals: figure(Count, "retrieval.count", "the number of retrievals: from `mark lost` to the next `mark found` of the same whisker").always()
        .named("retrievals").in_tests(),
    RetrievalRadius: figure(Length, "retrieval.radius_mm.mean", "the mean distance from the edge point to the retrieved point. Unknown without a retrieval")
        .smaller().named("retrieval_radius").bound(ERROR.0, ERROR.1).in_tests()
        .column_if_known(240, "retrieval radius mm", Spread).compared(60, "retrieval.radius_mm"),
    RetrievalRadiusStd: figure(Length, "retrieval.radius_mm.std", "the sample standard deviation"),
    RetrievalDistance: figure(Length, "retrieval.distance_mm.mean", "the mean path length of the platform during a retrieval. Unknown without a retrieval")
        .smaller().named("retrieval_distance").bound(ERROR.0, ERROR.1).in_tests()
        .column_if_known(250, "retrieval distance mm", Spread).compared(70, "retrieval.distance_mm"),
    RetrievalDistanceStd: figure(Length, "retrieval.distance_mm.std", "the sample standard deviation"),
    RetrievalTime: figure(Time, "retrieval.time_s.mean", "the mean"),
    RetrievalTimeStd: figure(Time, "retrieval.time_s.std", "the sample standard deviation"),

    AxisMean: figure(Length, "axis_mm.mean", "the mean distance of the estimated midpoints from the axis of a tunnel. Unknown outside of tunnels")
        .smaller().named("axis_mean").bound(ERROR.0, ERROR.1).in_tests()
        .column_if_known(190, "axis mm", Spread).compared(80, "axis_mm"),
    AxisStd: figure(Length, "axis_mm.std", "the sample standard deviation"),

    Corners: figure(Count, "corners.count", "the number of sharp corners").always(),
    CornersTraced: figure(Count, "corners.traced", "the number of corners that were traced on both sides. The figures are those of these corners").always()
        .larger().compared(90, "corners.traced"),
    CornerPlace: figure(Length, "corners.place_mm.mean", "the mean").smaller()
        .column_if_known(210, "corner position mm", Decimals(3)).compared(100, "corners.place_mm"),
    CornerPlaceStd: figure(Length, "corners.place_mm.std", "the sample standard deviation"),
    CornerPlaceTracedMax: figure(Length, "corners.place_mm.max", "the maximum"),
    CornerAngle: figure(Angle, "corners.angle_rad.mean", "the mean").smaller().compared(110, "corners.angle_rad"),
    CornerAngleStd: figure(Angle, "corners.angle_rad.std", "the sample standard deviation"),
    CornerAngleMax: figure(Angle, "corners.angle_rad.max", "the maximum"),
    CornerEdge: figure(Length, "corners.edge_mm.mean", "the mean"),
    CornerEdgeStd: figure(Length, "corners.edge_mm.std", "the sample standard deviation"),
    CornerEdgeMax: figure(Length, "corners.edge_mm.max", "the maximum"),
    CornerTime: figure(Time, "corners.time_s.mean", "the mean").smaller()
        .column_if_known(220, "corner time s", Decimals(1)).compared(120, "corners.time_s"),
    CornerTimeStd: figure(Time, "corners.time_s.std", "the sample standard deviation"),
    CornerTimeTracedMax: figure(Time, "corners.time_s.max", "the maximum"),
    CornerPath: figure(Length, "corners.path_m.mean", "the mean").smaller()
        .column_if_known(230, "corner path m", Decimals(2)).compared(130, "corners.path_m"),
    CornerPathStd: figure(Length, "corners.path_m.std", "the sample standard deviation"),
    CornerPathTracedMax: figure(Length, "corners.path_m.max", "the maximum"),
    CornerPlaceMax: Figure::without_key(Length, "the maximum error of the estimated positions of sharp corners. Unknown if there is no sharp corner, or if one was not traced")
        .smaller().named("corner_place_max").bound(ERROR.0, ERROR.1).in_tests(),
    CornerTimeMax: Figure::without_key(Time, "the maximum time for a sharp corner. Unknown if there is no sharp corner, or if one was not traced")
        .smaller().named("corner_time_max").bound((1e-3, 86_400.0), "3 s").in_tests(),
    CornerPathMax: Figure::without_key(Length, "the maximum path length of the platform for a sharp corner. Unknown if there is no sharp corner, or if one was not traced")
        .smaller().named("corner_path_max").bound((1e-9, 1e3), "15 cm").in_tests(),

    Path: figure(Length, "path_m", "the length of the path of the platform's centre of mass").always()
        .smaller().named("path").compared(150, "path_m"),
    PathRatio: figure(Ratio, "path_ratio", "the ratio of that length to the length of the reference contour").always(),

    Collisions: figure(Count, "collisions.count", "the number of collisions of the platform's body").always()
        .smaller().named("collisions").bound(COUNT.0, COUNT.1).in_tests()
        .column_if_known(100, "collisions", Positive(0)).compared(140, "collisions"),
    CollisionTime: figure(Time, "collisions.time_s", "the time in contact").always(),

    OutOfPlaneMax: figure(Length, "out_of_plane.max_mm", "the largest distance of a tip from the plane. Unknown for planar whiskers").always()
        .smaller().named("out_of_plane_max").bound(ERROR.0, ERROR.1)
        .column_if_known(120, "out of plane mm", Decimals(3)),
    Slips: figure(Count, "out_of_plane.slips", "the number of slips: a tip came above the top or below the bottom of the objects. Unknown for planar whiskers").always()
        .smaller().named("slips").bound(COUNT.0, COUNT.1).column_if_known(130, "slips", Decimals(0)),

    InclinationMax: figure(Angle, "inclination.max_rad", "the largest angle between a shaft at its base and the surface: \u{3c0}/2 if they are perpendicular, less if the shaft is swept back").always(),
    InclinationMargin: figure(Angle, "inclination.margin_rad", "the smallest margin by which a round whisker stays in the plane. A real whisker with a negative margin slips out of the plane").always(),
    InclinationBeyond: figure(Time, "inclination.beyond_s", "the time in which whiskers are inclined so much that a round one leaves the plane, added over all whiskers. Unknown if no whisker recorded a contour").always()
        .smaller().named("inclination_beyond").bound((1e-9, 1.0), "0.1 s").in_tests()
        .column_if_known(260, "beyond inclination limit s", Positive(1)),

    TickMean: figure(Time, "tick_us.mean", "the mean").column(280, "tick \u{b5}s", Decimals(1)),
    TickP99: figure(Time, "tick_us.p99", "the 99th percentile"),
    TickMax: figure(Time, "tick_us.max", "the maximum"),
}

impl Metric {
    /// The declaration.
    #[must_use]
    pub fn figure(self) -> &'static Figure {
        &FIGURES[self as usize]
    }

    /// The metric with this name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|metric| metric.figure().name == Some(name))
    }

    /// The name in `expect`, in tests of policies and in objectives. Empty without one.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.figure().name.unwrap_or_default()
    }

    /// The metric whose key differs only in its last part: for instance the standard deviation beside a mean.
    #[must_use]
    pub fn beside(self, last: &str) -> Option<Self> {
        let (group, _) = self.figure().key?.rsplit_once('.')?;
        let is_beside = |key: &str| key.rsplit_once('.') == Some((group, last));
        Self::ALL.into_iter().find(|metric| metric.figure().key.is_some_and(is_beside))
    }
}
