"""Tables of points on the page: the same numbers as Python's reader, or a refusal as it has."""

import json

import pytest

from symtop_ros.base.refusals import RefusedError
from symtop_ros.truth.fit.files import read_rows

PARSE = """async (text) => {
    const { parseTable } = await import("/film/table.js");
    try {
        return parseTable(text, "a.csv");
    } catch (error) {
        if (!(error instanceof RangeError)) throw error;
        return error.message;
    }
}"""
HEADS = {
    "t,u,v": "pixels",
    "t,v,u": "pixels",
    "u,v,t": "pixels",
    "t,x,y": "pixels",
    "t,pixel_x,pixel_y": "pixels",
    "Time (s),point x,point y": "pixels",
    "# t, u, v": "pixels",
    '"t","u (px)","v (px)"': "pixels",
    "t [ms],u,v": "pixels",
    "t_ms,u,v": "pixels",
    "time (us),u,v": "pixels",
    "time_ns,u,v": "pixels",
    "T , U , V": "pixels",
    "t,x,y,z": "axis",
    "z,y,x,t": "axis",
    "__time,/top/axis/x,/top/axis/y,/top/axis/z": "axis",
    "t,e_x,e_y,e_z": "axis",
    "timestamp,axis.x,axis.y,axis.z": "axis",
    "seconds,x (m),y (m),z (m)": "axis",
    "frame,t,x,y,z,note": "axis",
    "t,x,y,z,u,v": "pixels",
}
NUMBERS = ("0", "1", "-2.5", "+3", ".5", "7.", "1e-3", "-4.25E+02", "12345.678901234", "0.1")
# Columns of other kinds, which the page leaves to top_fit.
OTHERS = (
    "t,theta,phi",
    "t,theta",
    "t,wx,wy,wz",
    "t,w,x,y,z",
    "t,q0,q1,q2,q3",
    "t,wx,wy,wz,fx,fy,fz",
    "Time (s),Gyroscope x (rad/s),Gyroscope y (rad/s),Gyroscope z (rad/s)",
    "t,measured_wx,measured_wy,measured_wz",
)
REFUSED = (
    "",
    "\n\n",
    "hello",
    "t,u\n0,1",
    "u,v\n0,1",
    "t,u,v\n0,1,two",
    "t,u,v\n0,1",
    "t,u,v\n0,1,2,9",
    "t,u,v\n0,1,inf",
    "t,u,v\n0,1,0x10",
    "t,u,v\n0,1,1_0",
    "t,u,v\n0,1,1e999",
    "t,u,v\n0,1,--2",
    "t,u,u,v\n0,1,2,3",
    "t,x,x,y\n0,1,2,3",
    "a\nb\nc\nd\ne\nf\ng\nh\ni\nj\nt,u,v\n0,1,2",
)


def write(head, separator=",", comma=False, rows=4):
    """Return a table with a head, in other separators or with decimal commas."""
    width = head.count(",") + 1
    cells = [[NUMBERS[(3 * k + j) % len(NUMBERS)] for j in range(width)] for k in range(rows)]
    body = [separator.join(row) for row in cells]
    text = "\n".join([head.replace(",", separator), *body])
    return text.replace(".", ",") if comma else text


def list_tables():
    """Return tables of which the page takes each, by what is odd about them."""
    tables = {head: write(head) for head in HEADS}
    plain = [head for head in HEADS if "." not in head]
    tables |= {f"tabs {head}": write(head, "\t") for head in HEADS}
    tables |= {f"semicolons {head}": write(head, ";") for head in HEADS}
    tables |= {f"commas {head}": write(head, ";", comma=True) for head in plain}
    tables |= {f"commas and tabs {head}": write(head, "\t", comma=True) for head in plain}
    tables["spaces"] = "t x y\n0   1 2\n 1  2.5 3\n"
    tables["a line before the names"] = "mass A\nt\tx\ty\n0\t1\t2\n1\t\t3\n2\t5\t6\n"
    tables["comments"] = "# a film\n\n# of a top\nt,u,v\n0,1,2\n# here it was hidden\n1,2,3\n"
    tables["empty cells"] = "t,u,v\n0,1,2\n1,,3\n,4,5\n3,4,\n4,5,6\n"
    tables["other words for nothing"] = "t,u,v\n0,1,2\n1,nan,3\n2,NA,5\n3,4,null\n4,-,6\n5,6,7\n"
    tables["a cell without a name that is empty"] = "t,u,v\n0,1,2,\n1,2,3,\n"
    tables["quoted cells"] = 't,u,v,note\n0,1,2,"a, b"\n"1","2","3","say ""x"""\n'
    tables["ends of lines"] = "\ufefft,u,v\r\n0,1,2\r\n1,2,3\r\n"
    tables["whole stamps"] = "stamp,x,y,z\n1700000000000000000,0,1,2\n1700000000010000000,0,1,2\n"
    tables["no rows"] = "t,u,v\n"
    return tables


def read(path, text):
    """Return what Python reads: a kind, times and rows, and how many are left out."""
    path.write_text(text, encoding="utf-8", newline="")
    rows = read_rows(path, None)
    if rows.kind not in {"pixels", "axis"}:
        rows = read_rows(path, "pixels")
    empty = [int(note.split()[0]) for note in rows.notes if note.endswith("left out")]
    return rows, sum(empty)


@pytest.mark.parametrize("name", list_tables())
def test_a_table_has_the_numbers_that_python_reads(tab, name, tmp_path):
    text = list_tables()[name]
    rows, empty = read(tmp_path / "a.csv", text)
    found = tab.evaluate(PARSE, text)
    assert not isinstance(found, str), found
    assert found["kind"] == rows.kind == HEADS.get(name, rows.kind)
    assert found["values"] == rows.values.tolist()
    # Python's times are as exact as the text; a stamp of ns since 1970 as a double is off by 128 ns
    rounding = 256e-9 if "stamp" in text else 1e-15
    assert found["times"] == pytest.approx(rows.times.tolist(), rel=1e-15, abs=rounding)
    assert found["empty"] == empty


@pytest.mark.parametrize("text", REFUSED, ids=json.dumps)
def test_what_python_refuses_the_page_refuses_in_a_line(tab, text, tmp_path):
    with pytest.raises(RefusedError):
        read(tmp_path / "a.csv", text)
    found = tab.evaluate(PARSE, text)
    assert isinstance(found, str)
    assert "\n" not in found
    assert "a.csv must" in found or found.startswith("line 2 of a.csv must")


@pytest.mark.parametrize("head", OTHERS)
def test_a_record_of_another_kind_is_left_to_top_fit_with_its_command(tab, head):
    found = tab.evaluate(PARSE, write(head))
    assert found.endswith("type: top_fit a.csv")
