"""Every format that the program reads or writes: what dialogs, drops and commands know of files.

A new format is a file of its own and an entry here. The order is that in which files are
recognised, and in which maps are offered.
"""

from __future__ import annotations

from processing.core.text import Text
from processing.formats.format import BY_MAKER, Content, Format
from processing.formats.format_list import FormatList
from processing.formats.map_delivery import (
    DeliveryOptions,
    DmOptions,
    DxfOptions,
    LandXmlOptions,
    OpenDriveOptions,
    QualityOptions,
    RoadModelOptions,
    SectionOptions,
    ShapefileOptions,
    SheetOptions,
    TableOptions,
    WorkbookOptions,
)

_POINTS = "processing.formats.points"
_PATHS = "processing.formats.trajectories"
_VECTORS = "processing.formats.vectors"
_SURFACES = "processing.formats.surfaces"
_SURVEY = "processing.formats.survey"
_DRAWINGS = "processing.formats.drawings"
_LEDGERS = "processing.formats.ledgers.ledger_csv"
_LAS = f"{_POINTS}.las.las:read_chunks"
_RESULTS = f"{_POINTS}.las_results:write_results"
_TRUTH = f"{_POINTS}.point_codes:read_truth"
_LINES = f"{_VECTORS}.line_files:read_lines"

_POINT_FORMATS = (
    Format(
        "las",
        Text.same("LAS"),
        (".las",),
        reads={Content.POINTS: _LAS, Content.CLASSES: _TRUTH},
        writes={Content.POINTS: _RESULTS},
        magic=b"LASF",
        map_title=Text("Labelled points (LAS)", "ラベル付き点群（LAS）"),
        writes_map=f"{_POINTS}.las_results:write_points_map",
        has_attributes=False,
    ),
    Format(
        "laz",
        Text.same("LAZ"),
        (".laz",),
        reads={Content.POINTS: _LAS, Content.CLASSES: _TRUTH},
        writes={Content.POINTS: _RESULTS},
        magic=b"LASF",
    ),
    Format(
        "ply",
        Text.same("PLY"),
        (".ply",),
        reads={Content.POINTS: f"{_POINTS}.ply:open_ply"},
        magic=b"ply",
    ),
    Format(
        "e57",
        Text.same("E57"),
        (".e57",),
        reads={Content.POINTS: f"{_POINTS}.e57:open_e57"},
        magic=b"ASTM-E57",
    ),
    Format(
        "pulsewaves",
        Text.same("PulseWaves"),
        (".pls",),
        reads={Content.POINTS: f"{_POINTS}.pulsewaves.pulsewaves:open_pulsewaves"},
        magic=b"PulseWaves",
    ),
    Format(
        "ptx",
        Text.same("PTX"),
        (".ptx",),
        reads={Content.POINTS: f"{_POINTS}.ptx:open_ptx"},
        sniff=f"{_POINTS}.ptx:is_ptx",
    ),
    Format(
        "pcd",
        Text.same("PCD"),
        (".pcd",),
        reads={Content.POINTS: f"{_POINTS}.pcd:open_pcd"},
        sniff=f"{_POINTS}.pcd:is_pcd",
    ),
    Format(
        "text",
        Text("Text", "テキスト"),
        (".pts", ".xyz", ".txt", ".csv"),
        reads={
            Content.POINTS: f"{_POINTS}.text.text_points:open_text_points",
            Content.CLASSES: _TRUTH,
        },
    ),
    Format(
        "pulses",
        Text("Folder of pulses", "パルスとエコーのフォルダ"),
        (),
        reads={Content.POINTS: f"{_POINTS}.pulse_folder:open_pulse_folder"},
        sniff_folder=f"{_POINTS}.pulse_folder:is_pulse_folder",
    ),
    Format(
        "npy",
        Text.same("NPY"),
        (".npy",),
        reads={Content.CLASSES: _TRUTH},
        magic=b"\x93NUMPY",
    ),
    Format(
        "npz",
        Text.same("NPZ"),
        (".npz",),
        reads={Content.CLASSES: _TRUTH},
        magic=b"PK\x03\x04",
    ),
)

_PATH_FORMATS = (
    Format(
        "image-list",
        Text("Image list (CSV)", "画像一覧（CSV）"),
        (".csv", ".txt"),
        reads={Content.IMAGES: f"{_PATHS}.image_list:read_image_list"},
        sniff=f"{_PATHS}.image_list:is_image_list",
    ),
    Format(
        "trajectory",
        Text("Trajectory (CSV, POSPac text)", "走行軌跡（CSV・POSPacのテキスト）"),
        (".csv", ".txt"),
        reads={Content.TRAJECTORY: f"{_PATHS}.trajectory_csv:read_trajectory_table"},
        sniff=f"{_PATHS}.trajectory_csv:is_trajectory_table",
    ),
    Format(
        "sbet",
        Text.same("SBET"),
        (".out", ".sbet"),
        reads={Content.TRAJECTORY: f"{_PATHS}.sbet:read_sbet"},
        sniff=f"{_PATHS}.sbet:is_sbet",
        needs_crs=True,
    ),
)

_VECTOR_FORMATS = (
    Format(
        "dxf",
        Text.same("DXF"),
        (".dxf",),
        reads={
            Content.FEATURES: f"{_DRAWINGS}.drawn_features:read_dxf_features",
            Content.AREAS: f"{_VECTORS}.boundary_files:areas_of_dxf",
            Content.LINES: _LINES,
        },
        writes={
            Content.FEATURES: f"{_DRAWINGS}.dxf:write_dxf_features",
            Content.DRAWING: BY_MAKER,
        },
        layers=f"{_VECTORS}.boundary_files:layers_of_dxf",
        map_title=Text("Drawing (DXF)", "図面（DXF）"),
        options=DxfOptions,
    ),
    Format(
        "csv",
        Text.same("CSV"),
        (".csv",),
        writes={
            Content.FEATURES: f"{_LEDGERS}:write_csv_features",
            Content.TABLE: BY_MAKER,
            Content.REPORT: BY_MAKER,
        },
        map_title=Text("Ledgers (CSV)", "台帳（CSV）"),
        writes_map=f"{_LEDGERS}:write_csv_map",
        options=TableOptions,
    ),
    Format(
        "gpkg",
        Text.same("GeoPackage"),
        (".gpkg",),
        reads={
            Content.FEATURES: f"{_VECTORS}.mapped_shapes:read_geopackage_features",
            Content.AREAS: f"{_VECTORS}.boundary_files:areas_of_geopackage",
            Content.LINES: _LINES,
        },
        writes={Content.FEATURES: f"{_VECTORS}.geopackage:write_geopackage_features"},
        layers=f"{_VECTORS}.boundary_files:layers_of_geopackage",
        map_title=Text("GIS (GeoPackage)", "GIS（GeoPackage）"),
        writes_map=f"{_VECTORS}.geopackage:write_geopackage_map",
    ),
    Format(
        "geojson",
        Text.same("GeoJSON"),
        (".geojson",),
        reads={
            Content.FEATURES: f"{_VECTORS}.mapped_shapes:read_geojson_features",
            Content.AREAS: f"{_VECTORS}.boundary_files:areas_of_geojson",
            Content.LINES: _LINES,
        },
        writes={Content.FEATURES: f"{_VECTORS}.geojson:write_geojson_features"},
        map_title=Text("GIS (GeoJSON)", "GIS（GeoJSON）"),
    ),
    Format(
        "xlsx",
        Text.same("XLSX"),
        (".xlsx",),
        writes={Content.REPORT: BY_MAKER},
        map_title=Text("Ledgers (XLSX)", "台帳（XLSX）"),
        writes_map="processing.formats.ledgers.ledger_xlsx:write_xlsx_map",
        options=WorkbookOptions,
    ),
    Format(
        "shp",
        Text.same("Shapefile"),
        (".shp",),
        reads={Content.FEATURES: f"{_VECTORS}.shapefile_reading:read_shapefile_features"},
        writes={Content.FEATURES: BY_MAKER},
        map_title=Text("GIS (Shapefile)", "GIS（Shapefile）"),
        writes_map=f"{_VECTORS}.shapefile:write_shapefile_map",
        options=ShapefileOptions,
    ),
    Format(
        "kmz",
        Text.same("KMZ"),
        (".kmz",),
        writes={Content.FEATURES: f"{_VECTORS}.kmz:write_kmz_features"},
        map_title=Text("Globe (KMZ, WGS 84)", "地球儀ソフト（KMZ、WGS 84）"),
        needs_crs=True,
    ),
)

_OTHER_FORMATS = (
    Format(
        "landxml",
        Text.same("LandXML"),
        (".xml", ".landxml"),
        reads={Content.SURFACE: f"{_SURFACES}.landxml:read_landxml"},
        writes={Content.SURFACE: BY_MAKER},
        map_title=Text("Alignments and sections (LandXML)", "線形・断面（LandXML）"),
        writes_map="processing.formats.sections.section_landxml:write_landxml_map",
        options=LandXmlOptions,
        has_attributes=False,
    ),
    Format(
        "opendrive",
        Text.same("OpenDRIVE"),
        (".xodr",),
        writes={Content.FEATURES: "processing.formats.roads.opendrive:write_opendrive_features"},
        map_title=Text("Roads and lanes (OpenDRIVE)", "道路・車線（OpenDRIVE）"),
        options=OpenDriveOptions,
        has_attributes=False,
    ),
    Format(
        "geotiff",
        Text.same("GeoTIFF"),
        (".tif", ".tiff"),
        writes={Content.RASTER: BY_MAKER},
    ),
    Format(
        "pdf",
        Text.same("PDF"),
        (".pdf",),
        writes={
            Content.REPORT: BY_MAKER,
            Content.PLOT: BY_MAKER,
        },
    ),
    Format(
        "qa",
        Text("Quality report", "品質評価表"),
        (),
        map_title=Text("Quality report (PDF, HTML, JSON)", "品質評価表（PDF・HTML・JSON）"),
        writes_map="processing.formats.reports.quality.quality_report:write_quality_map",
        options=QualityOptions,
        has_attributes=False,
    ),
    Format(
        "png",
        Text.same("PNG"),
        (".png",),
        writes={
            Content.PICTURE: BY_MAKER,
            Content.PLOT: BY_MAKER,
        },
    ),
    Format(
        "json",
        Text.same("JSON"),
        (".json",),
        reads={
            Content.FEATURES: f"{_VECTORS}.mapped_shapes:read_geojson_features",
            Content.AREAS: f"{_VECTORS}.boundary_files:areas_of_geojson",
            Content.LINES: _LINES,
        },
        writes={Content.NUMBERS: BY_MAKER},
    ),
    Format(
        "toml",
        Text.same("TOML"),
        (".toml",),
        reads={
            Content.CATALOGUE: "processing.map.catalogue_file:read_catalogue",
            Content.LIMITS: "processing.methods.earthwork.as_built.limits_file:read_limits",
        },
        writes={Content.CATALOGUE: BY_MAKER, Content.LIMITS: BY_MAKER},
    ),
)

_SURVEY_FORMATS = (
    Format(
        "dm",
        Text("Extended DM", "拡張DM"),
        (".dm",),
        reads={Content.FEATURES: f"{_SURVEY}.dm_reading:read_dm_features"},
        writes={Content.FEATURES: BY_MAKER},
        map_title=Text("Map sheets (extended DM)", "図郭（拡張DM）"),
        writes_map=f"{_SURVEY}.dm:write_dm_map",
        options=DmOptions,
        needs_crs=True,
        has_attributes=False,
    ),
    Format(
        "sima",
        Text.same("SIMA"),
        (".sim",),
        reads={Content.FEATURES: f"{_SURVEY}.sima_reading:read_sima_features"},
        writes={Content.FEATURES: f"{_SURVEY}.sima:write_sima_features"},
        map_title=Text("Points and parcels (SIMA)", "座標・区画（SIMA）"),
        has_attributes=False,
    ),
    Format(
        "sxf",
        Text.same("SXF"),
        (".sfc", ".p21"),
        writes={Content.DRAWING: BY_MAKER},
        map_title=Text("Drawing (SXF)", "図面（SXF）"),
        writes_map=f"{_DRAWINGS}.sxf:write_sxf_map",
        has_attributes=False,
    ),
    Format(
        "delivery",
        Text("Electronic delivery", "電子納品"),
        (),
        map_title=Text("Electronic delivery (folder)", "電子納品（フォルダ一式）"),
        writes_map="processing.formats.delivery.survey_delivery:write_delivery_map",
        options=DeliveryOptions,
        needs_crs=True,
        has_attributes=False,
    ),
    Format(
        "sheets",
        Text("Drawing sheets", "図面（図郭割り）"),
        (),
        map_title=Text("Drawing sheets (DXF, PDF)", "図面（図郭割り、DXF・PDF）"),
        writes_map="processing.formats.sheets.sheet_files:write_sheets_map",
        options=SheetOptions,
        pages="sheets.pdf",
        has_attributes=False,
    ),
    Format(
        "sections",
        Text("Sections along routes", "路線の縦断・横断図"),
        (),
        map_title=Text(
            "Longitudinal and cross sections (DXF, PDF, CSV)", "縦断・横断図（DXF・PDF・CSV）"
        ),
        writes_map="processing.formats.sections.section_files:write_sections_map",
        options=SectionOptions,
        pages="sections.pdf",
        has_attributes=False,
    ),
    Format(
        "road",
        Text("Road model", "道路モデル"),
        (),
        map_title=Text(
            "Road model: widths, falls, slopes, clearance (CSV, XLSX, PDF, SVG, PNG)",
            "道路モデル: 幅員・勾配・建築限界（CSV・XLSX・PDF・SVG・PNG）",
        ),
        writes_map="processing.formats.roads.road_files:write_road_map",
        options=RoadModelOptions,
        pages="road.pdf",
        has_attributes=False,
    ),
)

FORMATS = FormatList(
    (*_VECTOR_FORMATS, *_SURVEY_FORMATS, *_POINT_FORMATS, *_PATH_FORMATS, *_OTHER_FORMATS)
)
"""The formats of the program."""
