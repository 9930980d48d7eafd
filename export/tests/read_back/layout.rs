//! The layout for PlotJuggler plots what an export has.

use towmag_export::{Format, encode, read_from};

#[test]
fn its_curves_are_series_of_an_mcap_file() {
    let layout = include_str!("../../../docs/plotjuggler-towmag.xml");
    let names: Vec<&str> = layout.split("<curve ").skip(1).filter_map(|rest| rest.split('"').nth(1)).collect();
    assert!(names.len() >= 4, "{names:?}");
    // What `replay` writes of a recording with a depth.
    let csv = "time_s,scalar_nT,flux_x_nT,flux_y_nT,flux_z_nT,depth_m,interference_nT,compensated_nT,residual_nT\n\
               0.1,50000,1,2,3,4,5,6,7\n";
    let table = read_from("compensated.csv", csv.as_bytes()).unwrap();
    let bytes = encode(&table, Format::Mcap, &towmag_export::Options::default()).unwrap();
    let message = ::mcap::MessageStream::new(&bytes).unwrap().next().unwrap().unwrap();
    let row: serde_json::Value = serde_json::from_slice(&message.data).unwrap();
    for name in names {
        // PlotJuggler names a series by its topic and its key.
        let key = name.strip_prefix(&format!("{}/", message.channel.topic)).unwrap();
        assert!(row[key].is_number(), "{name}");
    }
    // As often closed as opened, and each splitter as many areas as it says.
    for tag in ["root", "tabbed_widget", "Tab", "Container", "DockSplitter", "DockArea", "plot"] {
        let opened = layout.matches(&format!("<{tag} ")).count() + layout.matches(&format!("<{tag}>")).count();
        assert_eq!(opened, layout.matches(&format!("</{tag}>")).count(), "{tag}");
    }
    let areas = layout.matches("<DockArea ").count();
    assert!(layout.contains(&format!("count=\"{areas}\"")), "{areas}");
}
