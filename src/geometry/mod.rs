//! Poses, contours, distances.
