"""Stands in for ebsynth: reads its command line as it does, and paints every segment flat.

usage: ebsynth.py -style FILE [-weight N] [-guide FILE FILE [-weight N]]... -output FILE ...
Appends a line of the weights of each channel to ./weights: those of the style, then of each guide by name.

       ebsynth.py FILE X Y: prints red, green and blue of a pixel.
"""
import struct
import sys
import zlib


def read_png(path):
    """Returns width, height and pixels as RGBA tuples of an 8-bit file without interlacing."""
    data = open(path, 'rb').read()
    at, stream = 8, b''
    while at < len(data):
        length, = struct.unpack('>I', data[at:at + 4])
        kind, body = data[at + 4:at + 8], data[at + 8:at + 8 + length]
        at += 12 + length
        if kind == b'IHDR':
            width, height, depth, colours, _, _, interlaced = struct.unpack('>IIBBBBB', body)
        if kind == b'IDAT':
            stream += body
    assert depth == 8 and not interlaced, path
    n = {0: 1, 2: 3, 6: 4}[colours]
    raw, above, pixels = zlib.decompress(stream), bytearray(width * n), []
    for y in range(height):
        start = y * (width * n + 1)
        row = bytearray(raw[start + 1:start + 1 + width * n])
        for i in range(width * n):
            left, up, corner = (row[i - n], above[i], above[i - n]) if i >= n else (0, above[i], 0)
            nearest = min((left, up, corner), key=lambda v: abs(left + up - corner - v))
            row[i] = row[i] + (0, left, up, (left + up) // 2, nearest)[raw[start]] & 255
        above = row
        for p in zip(*[iter(row)] * n):
            pixels.append(p * 3 + (255,) if n == 1 else p + (255,) if n == 3 else p)
    return width, height, pixels


def write_png(path, width, height, pixels):
    def chunk(kind, body):
        return struct.pack('>I', len(body)) + kind + body + struct.pack('>I', zlib.crc32(kind + body))
    rows = b''.join(b'\0' + bytes(v for p in pixels[y * width:(y + 1) * width] for v in p) for y in range(height))
    header = struct.pack('>IIBBBBB', width, height, 8, 2, 0, 0, 0)
    open(path, 'wb').write(b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', header) + chunk(b'IDAT', zlib.compress(rows))
                           + chunk(b'IEND', b''))


def channels(pixels):
    """As ebsynth counts them: one if all are grey, and one more if any is not opaque."""
    return (1 if all(r == g == b for r, g, b, _ in pixels) else 3) + any(a < 255 for _, _, _, a in pixels)


def run(words):
    style, guides, output, weights = None, [], 'output.png', []
    while words:
        word = words.pop(0)
        if word == '-style':
            style = words.pop(0)
            weights.insert(0, None)
            last = 0
        elif word == '-guide':
            guides.append((words.pop(0), words.pop(0)))
            weights.append(None)
            last = len(weights) - 1
        elif word == '-weight':
            weights[last] = float(words.pop(0))
        elif word == '-output':
            output = words.pop(0)
        elif word in ('-uniformity', '-stopthreshold'):
            assert float(words.pop(0)) >= 0
        elif word == '-patchsize':
            assert int(words[0]) >= 3 and int(words.pop(0)) % 2 == 1
        else:
            sys.exit(f'error: unrecognized option {word}')

    width, height, colours = read_png(style)
    report = [f'style {weights[0] / channels(colours):g}']
    target_size = None
    for (source, target), weight in zip(guides, weights[1:]):
        name = target.split('_target_')[0]
        source_width, source_height, of_source = read_png(source)
        target_width, target_height, of_target = read_png(target)
        assert (source_width, source_height) == (width, height), source
        assert target_size in (None, (target_width, target_height)), target
        target_size = target_width, target_height
        report.append(f'{name} {weight / max(channels(of_source), channels(of_target)):g}')
        if name == 'segment':
            segment, wanted = of_source, of_target
    assert 2 <= len(set(segment)) <= 3 and set(wanted) <= set(segment), 'outside, border, interior'
    # Colours of its own, so that nobody takes our paint for its.
    flat = {grey: (250, 250, 250) if grey[0] == 0 else (20, 60 + grey[0] // 2, 200) for grey in set(segment)}
    write_png(output, *target_size, [flat[p] for p in wanted])
    open('weights', 'a').write(' '.join(report) + '\n')


if sys.argv[1].startswith('-'):
    run(sys.argv[1:])
else:
    w, _, pixels_of = read_png(sys.argv[1])
    print(*pixels_of[int(sys.argv[3]) * w + int(sys.argv[2])][:3])
