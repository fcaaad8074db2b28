"""Attacks: pickles that would run code, take memory or time, or that no NumPy ever wrote."""

import io
import os
import pickle
import random
import struct
from pathlib import Path

import numpy as np
import pytest

from app.errors import ClearLinesError, InvalidFile, TooLarge
from app.formats import pickle_gate
from app.formats.inert_npy import read_label_npy
from app.formats.inert_pickle import InertArray, InertName, interpret
from app.formats.pickle_gate import walk
from app.vision.segments import Segments


def npy(body, shape=(1,)):
    stream = io.BytesIO()
    np.lib.format.write_array_header_1_0(stream, {"descr": "|O", "fortran_order": False, "shape": shape})
    return stream.getvalue() + body


def label_file(protocol=4):
    array = np.empty(2, object)
    array[0], array[1] = np.arange(4.0).reshape(2, 1, 2), np.arange(6.0).reshape(3, 1, 2)
    return npy(pickle.dumps(array, protocol=protocol), (2,))


class Runs:
    """Pickled, it makes a file when it is unpickled."""

    def __init__(self, path, call=os.system):
        self.path, self.call = path, call

    def __reduce__(self):
        return self.call, (f"touch {self.path}",)


@pytest.mark.parametrize("protocol", range(6))
@pytest.mark.parametrize("inside", [False, True])
def test_code_is_named_and_never_run(tmp_path, protocol, inside):
    mark = tmp_path / "ran"
    value = Runs(str(mark))
    if inside:
        array = np.empty(2, object)
        array[0], array[1] = np.zeros((2, 1, 2)), value
        value = array
    body = pickle.dumps(value, protocol=protocol)
    with pytest.raises(InvalidFile) as caught:
        read_label_npy(npy(body, (2,)))
    assert "system" in caught.value.message
    assert not mark.exists()
    pickle.loads(body)  # the same bytes do run in the real machine
    assert mark.exists()


S = b"X\x04\x00\x00\x00text"
ARRAY = b"cnumpy.core.multiarray\n_reconstruct\n(cnumpy\nndarray\n(K\x00tC\x01btR"
DTYPE = b"cnumpy\ndtype\n(X\x02\x00\x00\x00f8\x89\x88tR"
ATTACKS = {
    "GLOBAL": b"cos\nsystem\n.",
    "GLOBAL of a near name": b"cnumpy.core.multiarray\nscalar\n.",
    "GLOBAL with a dotted name": b"cnumpy\nndarray.tofile\n.",
    "GLOBAL of builtins": b"c__builtin__\neval\n.",
    "GLOBAL with bytes beyond ASCII": b"c\xff\xfe\nx\n.",
    "STACK_GLOBAL": b"\x80\x04X\x02\x00\x00\x00osX\x06\x00\x00\x00system\x93.",
    "STACK_GLOBAL of no text": b"\x80\x04K\x01K\x02\x93.",
    "STACK_GLOBAL of lists": b"\x80\x04]]\x93.",
    "INST": b"(X\x02\x00\x00\x00idios\nsystem\n.",
    "OBJ": b"(cos\nsystem\nX\x02\x00\x00\x00ido.",
    "NEWOBJ": b"\x80\x02cnumpy\nndarray\n)\x81.",
    "NEWOBJ_EX": b"\x80\x04cnumpy\nndarray\n)}\x92.",
    "EXT1": b"\x80\x02\x82\x01.",
    "EXT2": b"\x80\x02\x83\x01\x00.",
    "EXT4": b"\x80\x02\x84\x01\x00\x00\x00.",
    "PERSID": b"Pfile\n.",
    "BINPERSID": S + b"Q.",
    "DUP": S + b"2.",
    "DUP bomb": b"]" + b"2a" * 10_000 + b".",
    "POP": S + S + b"0.",
    "POP_MARK": S + b"(1.",
    "LONG": b"L123L\n.",
    "LONG1": b"\x80\x02\x8a\x01\x05.",
    "LONG4": b"\x80\x02\x8b\x04\x00\x00\x00\x01\x02\x03\x04.",
    "LONG4 that promises 2 GiB": b"\x80\x02\x8b\xff\xff\xff\x7f\x01.",
    "INT of 5,000 digits": b"I" + b"9" * 5000 + b"\n.",
    "INT over 32 bit": b"I99999999999\n.",
    "huge memo index": S + b"r\xff\xff\xff\x7f.",
    "huge memo index in text": S + b"p99999999999\n.",
    "negative memo index": S + b"p-1\n.",
    "memo never stored": b"h\x05.",
    "DICT": b"(d.",
    "EMPTY_DICT": b"}.",
    "SETITEM": b"}" + S + S + b"s.",
    "EMPTY_SET": b"\x80\x04\x8f.",
    "FROZENSET": b"\x80\x04(\x91.",
    "BYTEARRAY8 that promises 2^60": b"\x80\x05\x96" + struct.pack("<Q", 2**60) + b"x.",
    "BINBYTES8": b"\x80\x04\x8e" + struct.pack("<Q", 1) + b"x.",
    "BINUNICODE8": b"\x80\x04\x8d" + struct.pack("<Q", 1) + b"x.",
    "BINBYTES that promises 2 GiB": b"B\xff\xff\xff\x7fx.",
    "BINUNICODE that promises 2 GiB": b"X\xff\xff\xff\x7fx.",
    "NEXT_BUFFER": b"\x80\x05\x97.",
    "READONLY_BUFFER": b"\x80\x05\x97\x98.",
    "BINSTRING of Python 2": b"T\x01\x00\x00\x00b.",
    "STRING of Python 2": b"S'b'\n.",
    "empty": b"",
    "only STOP": b".",
    "no STOP": S,
    "STOP twice": S + b"..",
    "unknown opcode": b"\xff.",
    "tuple from an empty stack": b"\x86.",
    "a mark as the result": b"(.",
    "a flood of marks": b"(" * 20_000 + b".",
    "a flood of values": b"N" * 20_000 + b".",
    "tuples in tuples": b")" + b"\x85" * 20_000 + b".",
    "a tuple of hundreds": b"(" + b"N" * 300 + b"t.",
    "a group without a mark": b"t.",
    "APPEND to text": S + S + b"a.",
    "APPENDS to a tuple": b")(K\x01e.",
    "REDUCE of text": S + b")R.",
    "REDUCE of a list": b"])R.",
    "BUILD of text": S + b")b.",
    "BUILD of a global": b"cnumpy\ndtype\n)b.",
    "BUILD of a global with attributes": b"cnumpy\ndtype\n(NN)tb.",
    "BUILD of a list": b"])b.",
    "_reconstruct of another class": b"cnumpy.core.multiarray\n_reconstruct\n(cnumpy\ndtype\n(K\x00tC\x01btR.",
    "_reconstruct with a shape": b"cnumpy.core.multiarray\n_reconstruct\n(cnumpy\nndarray\n(M\xff\xfftC\x01btR.",
    "ndarray called": b"cnumpy\nndarray\n(J\xff\xff\xff\x7ftR.",
    "dtype of a tuple": b"cnumpy\ndtype\n(K\x01K\x02tR.",
    "encode in another codec": b"c_codecs\nencode\n(X\x01\x00\x00\x00aX\x03\x00\x00\x00zip\x74R.",
    "encode beyond latin-1": b"c_codecs\nencode\n(X\x03\x00\x00\x00\xe2\x82\xacX\x06\x00\x00\x00latin1tR.",
    "array never built": ARRAY + b".",
    "array that is no array": S + b".",
    "array in a list": b"](" + ARRAY + b"e.",
    "array with negative shape": ARRAY + b"(K\x01(J\xff\xff\xff\xfft" + DTYPE + b"\x89C\x00tb.",
    "array with nested shape": ARRAY + b"(K\x01((K\x01tt" + DTYPE + b"\x89C\x00tb.",
    "array of rank 9": ARRAY + b"(K\x01(" + b"K\x01" * 9 + b"t" + DTYPE + b"\x89C\x00tb.",
    "array built twice": ARRAY + (b"(K\x01(K\x01t" + DTYPE + b"\x89C\x08\0\0\0\0\0\0\0\0tb") * 2 + b".",
    "dtype built twice": DTYPE + b"(K\x03X\x01\x00\x00\x00<NNNJ\xff\xff\xff\xffJ\xff\xff\xff\xffK\x00tb" * 2 + b".",
}


@pytest.mark.parametrize("name", ATTACKS)
def test_attacks_are_refused(name):
    with pytest.raises(InvalidFile):
        read_label_npy(npy(ATTACKS[name]))
    stream = ATTACKS[name].rstrip(b".") + b"0" + ARRAY + b"."
    with pytest.raises(InvalidFile):
        read_label_npy(npy(stream))


def element(data, code=b"f8", order=b"<", shape=b"K\x01K\x02\x86", extra=b"NNN"):
    kind = b"cnumpy\ndtype\n(X" + struct.pack("<I", len(code)) + code + b"\x89\x88tR"
    kind += b"(K\x03X" + struct.pack("<I", len(order)) + order + extra + b"J\xff\xff\xff\xffJ\xff\xff\xff\xffK\x00tb"
    return ARRAY + b"(K\x01" + shape + kind + b"\x89B" + struct.pack("<I", len(data)) + data + b"tb"


def holding(*elements):
    kind = b"cnumpy\ndtype\n(X\x02\x00\x00\x00O8\x89\x88tR"
    kind += b"(K\x03X\x01\x00\x00\x00|NNNJ\xff\xff\xff\xffJ\xff\xff\xff\xffK?tb"
    return ARRAY + b"(K\x01(K" + bytes([len(elements)]) + b"t" + kind + b"\x89](" + b"".join(elements) + b"etb."


PAIR = struct.pack("<2d", 1.5, 2.5)


def test_the_hand_made_file_itself_is_right():
    assert read_label_npy(npy(holding(element(PAIR)))) == Segments.from_list([[[1.5, 2.5]]])
    big = struct.pack(">2d", 1.5, 2.5)
    assert read_label_npy(npy(holding(element(big, order=b">")))) == Segments.from_list([[[1.5, 2.5]]])


@pytest.mark.parametrize(
    "bad",
    [
        element(PAIR[:-1]),
        element(PAIR + b"x"),
        element(b""),
        element(PAIR, code=b"O8"),
        element(PAIR, code=b"V16"),
        element(PAIR, code=b"U2"),
        element(PAIR, code=b"f8,f8"),
        element(PAIR, code=b"M8"),
        element(PAIR, code=b"f999999999"),
        element(PAIR, order=b""),
        element(PAIR, order=b"<>"),
        element(PAIR, order=b"x"),
        element(PAIR, extra=b"N(X\x01\x00\x00\x00xtN"),
        element(PAIR, extra=b"(K\x01K\x02tNN"),
        element(b"", shape=b"K\x00J\xff\xff\xff\x7f\x86"),
        element(b"", shape=b"K\x00J\xff\xff\xff\x7fJ\xff\xff\xff\x7f\x87"),
        element(PAIR, shape=b"K\x02K\x02\x86"),
        element(PAIR, shape=b"J\xff\xff\xff\x7fJ\xff\xff\xff\x7f\x86"),
        element(struct.pack("<2d", 1, float("nan"))),
        b"N",
        b"]",
    ],
)
def test_elements_that_are_no_coordinates(bad):
    with pytest.raises(InvalidFile):
        read_label_npy(npy(holding(element(PAIR), bad), (2,)))


def test_an_array_that_holds_itself():
    array = np.empty(1, object)
    array[0] = array
    with pytest.raises(InvalidFile):
        read_label_npy(npy(pickle.dumps(array)))


def test_a_list_that_holds_itself():
    found = interpret(walk(b"]q\x00h\x00a.", where="file"), encoded_limit=0, where="file")
    assert found[0] is found
    with pytest.raises(InvalidFile):
        read_label_npy(npy(b"]q\x00h\x00a."))
    with pytest.raises(InvalidFile):
        read_label_npy(npy(holding(b"]q\x00h\x00a")))


def test_lists_of_lists_of_lists_cost_nothing():
    body = b"]q\x00" + b"".join(b"](" + (b"h" + bytes([n])) * 10 + b"eq" + bytes([n + 1]) for n in range(60))
    with pytest.raises(InvalidFile):
        read_label_npy(npy(body + b"."))


def test_strings_can_not_grow_beyond_the_file():
    text = b"a" * 10_000
    encode = b"c_codecs\nencode\nq\x01h\x00X\x06\x00\x00\x00latin1\x86q\x02R"
    body = b"X" + struct.pack("<I", len(text)) + text + b"q\x00" + encode + b"h\x01h\x02R" * 1000 + b"."
    with pytest.raises(InvalidFile) as caught:
        read_label_npy(npy(body))
    assert "grow beyond" in caught.value.message


def test_too_many_steps(monkeypatch):
    monkeypatch.setattr(pickle_gate, "OPCODE_LIMIT", 1000)
    with pytest.raises(TooLarge):
        read_label_npy(npy(b"N" * 2000 + b"."))


def test_stand_ins_share_nothing_between_files():
    program = list(walk(ARRAY + b".", where="file"))
    first, second = (interpret(program, encoded_limit=0, where="file") for _ in range(2))
    assert isinstance(first, InertArray)
    assert first is not second
    with pytest.raises(AttributeError):
        InertName("numpy", "dtype").name = "other"  # type: ignore[misc]


@pytest.mark.parametrize("protocol", [0, 2, 4, 5])
def test_mutated_files_are_read_or_refused_and_nothing_else(protocol, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    chance = random.Random(protocol)
    whole = label_file(protocol)
    read = 0
    for _ in range(1500):
        data = bytearray(whole)
        for _ in range(chance.randint(1, 4)):
            at = chance.randrange(len(data))
            match chance.randrange(4):
                case 0:
                    data[at] = chance.randrange(256)
                case 1:
                    data[at] ^= 1 << chance.randrange(8)
                case 2:
                    del data[at : at + chance.randint(1, 8)]
                case _:
                    start = chance.randrange(len(whole))
                    data[at:at] = whole[start : start + chance.randint(1, 16)]
        try:
            found = read_label_npy(bytes(data))
        except ClearLinesError:
            continue
        assert np.isfinite(found.points).all()
        read += 1
    assert read > 0
    assert list(Path(tmp_path).iterdir()) == []
