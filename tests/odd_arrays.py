"""Bytes of .npy files, most of them damaged."""

import io
import struct

import numpy as np

from botschool.paths import course_root

HOPPER = course_root() / "data" / "genotypes" / "planarhopper.npy"
GENOTYPE = np.load(HOPPER)


def npy(array):
    stream = io.BytesIO()
    np.save(stream, np.asarray(array))
    return stream.getvalue()


def headed(text, data=b"\0" * 8, version=b"\1\0", magic=b"\x93NUMPY"):
    """Return an .npy file with this header."""
    text = text.encode() + b"\n"
    return magic + version + struct.pack("<H", len(text)) + text + data


def shaped(shape, descr="'<f8'", order=False):
    return headed(f"{{'descr': {descr}, 'fortran_order': {order}, 'shape': {shape}, }}")


HEADERS = {
    "other magic": headed("", magic=b"\x93NUMPZ"),
    "version 9": headed(
        "{'descr': '<f8', 'fortran_order': False, 'shape': (1,), }", version=b"\x09\0"
    ),
    "no dictionary": headed("[1]"),
    "unary signs": headed("-" * 9000 + "1"),
    "brackets": headed("(" * 500),
    "half a string": headed("{'descr': '''<f8"),
    "objects": shaped("(1,)", "'|O'"),
    "2 GB a value": shaped("(1,)", "'|V2000000000'"),
    "fields": shaped("(1,)", "[('a', '<f8')]"),
    "huge shape": shaped("(1000000000000,)"),
    "huge product": shaped("(0, 99999999999999999999999)"),
    "negative": shaped("(-1,)"),
    "nested": shaped("((1,),)"),
    "true": shaped("(True,)"),
    "many dimensions": shaped("(1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1)"),
    "an order of 5": shaped("(1,)", order=5),
    "cut": npy(GENOTYPE)[:-3],
    "longer": npy(GENOTYPE) + b"\0",
    "cut header": npy(GENOTYPE)[:40],
    "empty": b"",
    "PK": b"PK\3\4" + b"\0" * 60,
    "nan": npy(GENOTYPE * np.nan),
    "infinite": npy(GENOTYPE * np.inf),
    "text": npy(["a"]),
    "other size": npy(np.zeros(3)),
    "two dimensions": npy(GENOTYPE[None]),
}
