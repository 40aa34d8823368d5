#include "io/sparse_stream.h"

#include "io/prefix_code.h"
#include <libdeflate.h>
#include <stdbool.h>
#include <string.h>

/* Deflate's numbers [RFC 1951 §3.2]. */
enum {
    DYNAMIC_CODES = 2, // the kind of a block
    END_OF_BLOCK = 256,
    FIRST_LENGTH = 257, // the symbol of a match of SHORTEST bytes
    SHORTEST = 3,
    LONGEST = 258,
    LENGTH_OF_LENGTHS = 4, // bits: all lengths, 0 … 15, have codes of that many
};

#define TOKENS (1 << 15)    // of a block, which has a code of its own
#define TOKEN_BITS 21       // at most: a symbol, the rest of a length, a distance
#define HEADER_BYTES 256    // of a block, at most, and of what is in no byte yet
#define ADLER_BASE 65521ULL // of the checksum, RFC 1950

/* A byte, or END_OF_BLOCK + the length of a match with the byte before; END_OF_BLOCK is itself. */
typedef uint16_t Token;
#define TOKEN_KINDS (END_OF_BLOCK + LONGEST + 1)

/* Bits that are no whole bytes yet, the first one the lowest, and where those go. */
typedef struct Writer {
    uint64_t bits;
    unsigned n_bits; // less than 8 after flush(), at most 64 before it
    uint8_t *to;     // with room for all that comes and eight bytes more: end_block() makes it
} Writer;

struct FlSparseStream {
    GByteArray *out;
    Writer writer; // its `to` is set while a block is written
    uint32_t sum;
    int last;   // the last byte, -1: none
    size_t run; // how many like `last` come after it that are no token yet
    int n_tokens;
    Token token[TOKENS];
};

/* ---- symbols --------------------------------------------------------------------------------- */

/** A length in deflate's way. */
typedef struct Length {
    int symbol, n_extra;
    unsigned extra;
} Length;

/* Four symbols for each size of the rest; the last symbol is the longest match. */
static Length length_of(int length)
{
    const unsigned l = (unsigned)(length - SHORTEST);
    if (length == LONGEST)
        return (Length){FL_CODE_SYMBOLS - 1, 0, 0};
    if (l < 8)
        return (Length){FIRST_LENGTH + (int)l, 0, 0};
    const int n_extra = (int)g_bit_storage(l) - 3;
    return (Length){FIRST_LENGTH + 4 * n_extra + (int)(l >> n_extra), n_extra,
                    l & ((1U << n_extra) - 1)};
}

/* ---- a block --------------------------------------------------------------------------------- */

/* Bits that are written together, the first one the lowest. */
typedef struct Bits {
    uint32_t bits;
    unsigned n; // at most 32
} Bits;

static inline void add_bits(Writer *writer, Bits put)
{
    writer->bits |= (uint64_t)put.bits << writer->n_bits;
    writer->n_bits += put.n;
}

/* Writes what is whole bytes. */
static inline void flush(Writer *writer)
{
    const uint64_t all = GUINT64_TO_LE(writer->bits);
    memcpy(writer->to, &all, sizeof all);
    writer->to += writer->n_bits / 8;
    writer->bits >>= writer->n_bits & ~7U;
    writer->n_bits &= 7;
}

static inline void put_bits(Writer *writer, Bits put)
{
    add_bits(writer, put);
    flush(writer);
}

/* The code of the block: of symbols, and of one distance, 1. */
static void put_code(Writer *writer, const FlPrefixCode *code)
{
    static const uint8_t reversed[] = {0, 8, 4, 12, 2, 10, 6, 14, 1, 9, 5, 13, 3, 11, 7, 15};
    put_bits(writer, (Bits){FL_CODE_SYMBOLS - 257, 5});
    put_bits(writer, (Bits){0, 5});
    put_bits(writer, (Bits){19 - 4, 4});
    for (int k = 0; k < 19; k++) // the first three repeat lengths
        put_bits(writer, (Bits){k < 3 ? 0 : LENGTH_OF_LENGTHS, 3});
    for (int s = 0; s < FL_CODE_SYMBOLS; s++)
        put_bits(writer, (Bits){reversed[code->length[s]], LENGTH_OF_LENGTHS});
    put_bits(writer, (Bits){reversed[1], LENGTH_OF_LENGTHS});
}

/* What a token is written as: of a match its length, what its symbol leaves open of that, and the
 * only code of a distance, 0. */
static Bits bits_of(const FlPrefixCode *code, int token)
{
    if (token <= END_OF_BLOCK)
        return (Bits){code->bits[token], code->length[token]};
    const Length length = length_of(MAX(token - END_OF_BLOCK, SHORTEST));
    const int n = code->length[length.symbol];
    return (Bits){code->bits[length.symbol] | length.extra << n, n + length.n_extra + 1};
}

#define TURNS 4 // counts of their own: a token that comes again need not wait for its count

/* How often a symbol comes in a block. */
static void count_symbols(const FlSparseStream *stream, uint32_t count[FL_CODE_SYMBOLS])
{
    uint32_t n[TURNS][TOKEN_KINDS] = {0};
    int k = 0;
    for (; k + TURNS <= stream->n_tokens; k += TURNS)
        for (int turn = 0; turn < TURNS; turn++)
            n[turn][stream->token[k + turn]]++;
    for (; k < stream->n_tokens; k++)
        n[0][stream->token[k]]++;
    for (int turn = 1; turn < TURNS; turn++)
        for (int token = 0; token < TOKEN_KINDS; token++)
            n[0][token] += n[turn][token];
    memcpy(count, n[0], END_OF_BLOCK * sizeof *count);
    memset(count + END_OF_BLOCK, 0, (FL_CODE_SYMBOLS - END_OF_BLOCK) * sizeof *count);
    for (int length = SHORTEST; length <= LONGEST; length++)
        count[length_of(length).symbol] += n[0][END_OF_BLOCK + length];
    count[END_OF_BLOCK] = 1;
    count[FL_CODE_SYMBOLS - 1]++; // a code has two symbols at least
}

/* Writes the block. Returns: where it ends. */
static Writer put_block(const FlSparseStream *stream, bool last, Writer writer)
{
    uint32_t count[FL_CODE_SYMBOLS];
    FlPrefixCode code;
    Bits bits[TOKEN_KINDS];
    count_symbols(stream, count);
    fl_prefix_code_init(&code, count);
    for (int t = 0; t < TOKEN_KINDS; t++)
        bits[t] = bits_of(&code, t);
    put_bits(&writer, (Bits){last, 1});
    put_bits(&writer, (Bits){DYNAMIC_CODES, 2});
    put_code(&writer, &code);
    for (int k = 0; k < stream->n_tokens; k += 2) {
        add_bits(&writer, bits[stream->token[k]]);
        if (k + 1 < stream->n_tokens)
            add_bits(&writer, bits[stream->token[k + 1]]);
        flush(&writer);
    }
    put_bits(&writer, bits[END_OF_BLOCK]);
    return writer;
}

/* last: of the stream. */
static void end_block(FlSparseStream *stream, bool last)
{
    GByteArray *out = stream->out;
    const guint before = out->len;
    g_byte_array_set_size(out, before + HEADER_BYTES + (guint)stream->n_tokens * TOKEN_BITS / 8);
    stream->writer.to = out->data + before;
    stream->writer = put_block(stream, last, stream->writer);
    g_byte_array_set_size(out, (guint)(stream->writer.to - out->data));
    stream->n_tokens = 0;
}

/* ---- bytes ----------------------------------------------------------------------------------- */

static void add_token(FlSparseStream *stream, int token)
{
    if (stream->n_tokens == TOKENS)
        end_block(stream, false);
    stream->token[stream->n_tokens++] = (Token)token;
}

/* The run at the end becomes matches; what is too short for one, bytes. */
static void end_run(FlSparseStream *stream)
{
    for (; stream->run >= SHORTEST; stream->run -= MIN(stream->run, LONGEST))
        add_token(stream, END_OF_BLOCK + (int)MIN(stream->run, LONGEST));
    for (; stream->run > 0; stream->run--)
        add_token(stream, stream->last);
}

static void add_byte(FlSparseStream *stream, uint8_t byte)
{
    if (stream->run > 0)
        end_run(stream);
    add_token(stream, byte);
    stream->last = byte;
}

#define EIGHT 8 // bytes that are looked at together

/* Adds bytes that are no run. */
static void add_eight(FlSparseStream *stream, const uint8_t *bytes)
{
    if (stream->run > 0)
        end_run(stream);
    if (stream->n_tokens + EIGHT > TOKENS)
        end_block(stream, false);
    Token *to = stream->token + stream->n_tokens;
    for (int k = 0; k < EIGHT; k++)
        to[k] = bytes[k];
    stream->n_tokens += EIGHT;
    stream->last = bytes[EIGHT - 1];
}

/* Eight bytes are a run, or none of them: shorter ones gain little where codes are short, and to
 * look for them takes longer than all else. */
static void add_bytes(FlSparseStream *stream, const uint8_t *bytes, size_t n)
{
    size_t k = 0;
    if (n > 0 && stream->last < 0)
        add_byte(stream, bytes[k++]);
    for (; k + EIGHT <= n; k += EIGHT) {
        uint64_t eight;
        memcpy(&eight, bytes + k, sizeof eight);
        if (eight == (uint8_t)stream->last * UINT64_C(0x0101010101010101))
            stream->run += EIGHT;
        else
            add_eight(stream, bytes + k);
    }
    for (; k < n; k++)
        if (bytes[k] == stream->last)
            stream->run++;
        else
            add_byte(stream, bytes[k]);
}

/* ---- the whole ------------------------------------------------------------------------------- */

FlSparseStream *fl_sparse_stream_new(GByteArray *out)
{
    static const uint8_t head[] = {0x78, 0x01}; // deflate, a window of 32 KiB
    FlSparseStream *stream = g_new0(FlSparseStream, 1);
    stream->out = out, stream->sum = 1, stream->last = -1;
    g_byte_array_append(out, head, sizeof head);
    return stream;
}

void fl_sparse_stream_put(FlSparseStream *stream, const uint8_t *bytes, size_t n)
{
    add_bytes(stream, bytes, n);
    stream->sum = libdeflate_adler32(stream->sum, bytes, n);
}

/* The checksum after a run. */
static uint32_t sum_with_run(uint32_t sum, uint8_t value, size_t n)
{
    const uint64_t m = n % (2 * ADLER_BASE); // a run of that many changes nothing
    const uint64_t low = sum & 0xffff, high = sum >> 16;
    const uint64_t rise = m * (m + 1) / 2 % ADLER_BASE * value;
    return (uint32_t)((high + m * low + rise) % ADLER_BASE << 16 | (low + m * value) % ADLER_BASE);
}

void fl_sparse_stream_run(FlSparseStream *stream, uint8_t value, size_t n)
{
    const bool begins = n > 0 && value != stream->last;
    if (begins)
        add_byte(stream, value);
    stream->run += n - begins;
    stream->sum = sum_with_run(stream->sum, value, n);
}

void fl_sparse_stream_end(FlSparseStream *stream)
{
    end_run(stream);
    end_block(stream, true);
    const uint32_t rest = GUINT32_TO_LE((uint32_t)stream->writer.bits);
    const uint32_t sum = GUINT32_TO_BE(stream->sum);
    g_byte_array_append(stream->out, (const uint8_t *)&rest,
                        (guint)(stream->writer.n_bits + 7) / 8);
    g_byte_array_append(stream->out, (const uint8_t *)&sum, sizeof sum);
    g_free(stream);
}
