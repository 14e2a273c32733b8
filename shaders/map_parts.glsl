// Where the texels of a map lie: the map, tile or face of a place, its levels, and the texels around a point.
#ifndef RELIEF_MAP_PARTS_GLSL
#define RELIEF_MAP_PARTS_GLSL

#include "inputs.glsl"

// Words are fetched in pairs, for neighbouring texels of small formats lie in the same one.
RELIEF_TABLE(kBindHeight, uvec2, wordsAt)

uint heightWord(int i) {
    uvec2 words = wordsAt(uint(i >> 1));
    return (i & 1) == 0 ? words.x : words.y;
}

// Where a height is looked up: a map's addressing says by which of these.
struct MapPlace {
    uint face;
    vec2 uv;
    vec2 st;
};

// The record of the map that holds a place.
uint mapAt(MapPlace place) { return 0u; }

// The map or tile that holds a place, and where in it.
struct MapPart {
    uint map;
    ivec2 size;    // texels of level 0; of a map per face log2 of its segments
    int first;     // sets: word where level 0 begins
    vec2 at;       // (s,t) in the tile, or (u,v)
    bool isThere;
};

// The tile of the unit square that holds a point. One on the border of a missing tile is a point of the tile beside it, as far
// as there is one: there the entry holds a bit for each of the nine squares around it.
MapPart tileAt(uint map, vec2 st) {
    ivec2 count = inputs.model.maps[map].tileCount;
    vec2 whole = clamp(floor(st), vec2(-1e6), vec2(1e6)), within = st - whole;
    ivec2 square = ivec2(whole) - inputs.model.maps[map].firstTile;
    bool isInGrid = all(greaterThanEqual(square, ivec2(0))) && all(lessThan(square, count));
    square = clamp(square, ivec2(0), count - 1);
#ifdef RELIEF_MUTANT_TILE // a test of the certificate: tiles are in the places of their neighbours
    square.x = min(square.x ^ 1, count.x - 1);
#endif
    uvec2 entry = wordsAt(uint(square.y * count.x + square.x));
    ivec2 beside = ivec2(greaterThan(within, vec2(1.0 - kTileRounding))) - ivec2(lessThan(within, vec2(kTileRounding)));
    ivec2 step = ivec2(0);
    if (entry.x == kNoTile)
        step = (entry.y >> (4 + beside.x) & 1u) != 0u        ? ivec2(beside.x, 0)
               : (entry.y >> (4 + 3 * beside.y) & 1u) != 0u ? ivec2(0, beside.y)
                                                             : beside;
    square = clamp(square + step, ivec2(0), count - 1);
    entry = wordsAt(uint(square.y * count.x + square.x));
    if (!isInGrid || entry.x == kNoTile) return MapPart(map, ivec2(1), 0, vec2(0), false);
    return MapPart(map, ivec2(entry.y & 0xffffu, entry.y >> 16), int(entry.x), st - (whole + vec2(step)), true);
}

MapPart partAt(MapPlace place) {
    uint map = mapAt(place);
    if (kMapAddressing == kMapOfTiles) return tileAt(map, place.st);
    if (kMapAddressing == kMapOfFaces) {
        uvec2 entry = wordsAt(place.face);
        return MapPart(map, ivec2(entry.y & 0xffffu, entry.y >> 16), int(entry.x), place.uv, true);
    }
    return MapPart(map, inputs.model.maps[map].size, 0, place.st, true);
}

// Texels per unit of s and t around a place.
vec2 texelsAt(vec2 st) { return vec2(partAt(MapPlace(0u, vec2(0), st)).size); }

uint lastLevel(MapPart part) {
    if (kMapAddressing == kMapOfTexture) return inputs.model.maps[part.map].levelCount - 1u;
    uint longest = uint(max(part.size.x, part.size.y));
    return kMapAddressing == kMapOfFaces ? longest : min(uint(findMSB(longest)), kMostMapLevels - 1u);
}

// The word where a level begins.
int firstOfLevel(MapPart part, uint number) {
    if (kMapAddressing == kMapOfTexture) return int(inputs.model.maps[part.map].firstWords[number]);
    int first = kVectorSpace == kVectorNone ? 0 : int(inputs.model.maps[part.map].firstWords[0]); // of the set's words
    return first + (number == 0u ? part.first : int(heightWord(first + part.first - int(number))));
}

// The columns or rows first - 1 to first + 2 of a map level of that size.
ivec4 wrapped(int first, int size, bool repeats) {
    if (!repeats) return clamp(first + ivec4(-1, 0, 1, 2), 0, size - 1);
    // The first one falls anywhere, each of the others is the next one or 0: of a level may be a single one.
    ivec4 at = ivec4(first - 1 - size * int(floor(float(first - 1) / float(size))));
    at.y = at.x + 1 == size ? 0 : at.x + 1;
    at.z = at.y + 1 == size ? 0 : at.y + 1;
    at.w = at.z + 1 == size ? 0 : at.z + 1;
    return at;
}

// The texels of a level around a point: columns and rows of the four by four that hold the point in their middle square.
struct MapTexels {
    ivec4 columns, rows;
    vec2 f;          // where in the middle square
    ivec2 stored;    // size of what is stored
    vec2 perUnit;    // texels or segments per unit of s and t, or of u and v; t goes against the rows
};

MapTexels texelsAround(MapPart part, uint number) {
    MapTexels t;
    if (kMapAddressing == kMapOfFaces) {
        ivec2 segments = ivec2(1) << max(part.size - int(number), 0);
        vec2 x = part.at * vec2(segments);
        vec2 whole = clamp(floor(x), vec2(0), vec2(segments - 1));
        t.f = x - whole;
        t.columns = int(whole.x) + kFaceApron + ivec4(-1, 0, 1, 2);
        t.rows = int(whole.y) + kFaceApron + ivec4(-1, 0, 1, 2);
        t.stored = segments + 1 + 2 * kFaceApron;
        t.perUnit = vec2(segments);
        return t;
    }
    ivec2 size = max(part.size >> int(number), 1);
    precise vec2 x = vec2(part.at.x, 1.0 - part.at.y) * vec2(size) - 0.5;
    vec2 whole = floor(x);
    if (kMapAddressing == kMapOfTiles) {
        whole = clamp(whole, vec2(-1), vec2(size - 1));
        t.columns = int(whole.x) + kTileApron + ivec4(-1, 0, 1, 2);
        t.rows = int(whole.y) + kTileApron + ivec4(-1, 0, 1, 2);
        t.stored = size + 2 * kTileApron;
    } else {
        bool repeats = inputs.model.maps[part.map].repeats != 0u;
        t.columns = wrapped(int(whole.x), size.x, repeats), t.rows = wrapped(int(whole.y), size.y, repeats);
        t.stored = size;
    }
    t.f = x - whole;
    t.perUnit = vec2(size.x, -size.y);
    return t;
}
#endif
