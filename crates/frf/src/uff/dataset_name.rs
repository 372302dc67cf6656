//! What the data sets hold that files of tests and of models have, and that are not read here.

/// What a data set of this number holds, where that is known.
pub(super) fn dataset_name(number: &str) -> Option<&'static str> {
    Some(match number.trim_end_matches('b') {
        "15" | "781" | "2411" => "nodes",
        "18" | "2420" => "coordinate systems",
        "55" => "data at nodes, such as mode shapes",
        "56" => "data at elements",
        "57" => "data at nodes of elements",
        "71" | "780" | "2412" => "elements",
        "82" | "2431" => "trace lines",
        "151" => "header of the file",
        "164" => "units",
        "1858" => "remarks on functions",
        "2400" => "header of a model",
        "2414" => "analysis data",
        "2429" | "2430" | "2432" | "2435" | "2452" | "2467" | "2477" => "groups",
        _ => return None,
    })
}
