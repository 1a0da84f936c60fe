"""Prints what pyuff reads: for each file named, per dataset one line, and numbers as the bits they are."""

import sys

import numpy
import pyuff

TEXTS = ["id1", "id2", "id3", "id4", "id5", "rsp_ent_name", "ref_ent_name"]
INTEGERS = ["func_type", "func_id", "ver_num", "load_case_id", "rsp_node", "rsp_dir", "ref_node", "ref_dir",
            "ord_data_type", "num_pts", "abscissa_spacing"]
REALS = ["abscissa_min", "abscissa_inc", "z_axis_value"]
AXES = ["abscissa", "ordinate", "orddenom", "z_axis"]


def bits(values):
    return " ".join(map("{:016x}".format, numpy.ascontiguousarray(values, dtype="f8").view("u8").tolist()))


def function(data):
    for key in TEXTS:
        print(data[key])
    print(*(data[key] for key in INTEGERS))
    print(bits([data[key] for key in REALS]))
    for axis in AXES:
        print(*(data[f"{axis}_{key}"] for key in ["spec_data_type", "len_unit_exp", "force_unit_exp", "temp_unit_exp"]))
        print(data[f"{axis}_axis_lab"])
        print(data[f"{axis}_axis_units_lab"])
    print(bits(data["x"]))
    print(bits(numpy.ascontiguousarray(data["data"]).view("f8")))


def nodes(data):
    for key in ["node_nums", "def_cs", "disp_cs", "color", "x", "y", "z"]:
        print(bits(data[key]))


def trace_line(data):
    print(data["trace_num"], data["n_nodes"], data["color"])
    print(data["id"])
    print(bits(data["nodes"]))


def file_header(data):
    for key in ["model_name", "description", "db_app", "program"]:
        print(data[key])


def units(data):
    print(data["units_code"], data["temp_mode"])
    print(data["units_description"])
    print(bits([data[key] for key in ["length", "force", "temp", "temp_offset"]]))


PRINTED = {15: nodes, 58: function, 82: trace_line, 151: file_header, 164: units, 2411: nodes}

sys.stdout.reconfigure(encoding="utf-8", newline="\n")
for path in sys.argv[1:]:
    file = pyuff.UFF(path)
    for index, number in enumerate(file.get_set_types()):
        try:
            data = file.read_sets(index)
        except Exception:
            print("dataset", number, "unread")
            continue
        print("dataset", number, "read" if number in PRINTED else "unread")
        if number in PRINTED:
            PRINTED[number](data)
    print("end")
